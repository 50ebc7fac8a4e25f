"""A survey of a log as plain data, schema `trialid-survey/1`."""

import math
from typing import Any, Final

from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.clocks import CALENDAR_NS, moment
from trialid.inspection.disagreements import findings
from trialid.inspection.inspected import ChannelInspection, Inspection

SCHEMA: Final = "trialid-survey/1"


def plain(survey: Inspection) -> dict[str, Any]:
    """The survey as plain data, schema `trialid-survey/1`; what is not known is null."""
    dated = survey.start > CALENDAR_NS
    return {
        "schema": SCHEMA,
        "path": str(survey.path),
        "format": survey.format,
        "duration": survey.duration,
        "start": f"{moment(survey.start)}Z" if dated else None,
        "files": [
            {"path": str(f.path), "format": f.format, "sha256": f.sha256, "remarks": [*f.remarks]}
            for f in survey.files
        ],
        "channels": [_channel(one) for one in survey.channels.values()],
        "findings": [_finding(one) for one in findings(survey)],
        "warnings": list(survey.warnings),
    }


def _finding(one: Finding) -> dict[str, Any]:
    return {
        "kind": one.kind,
        "severity": one.severity,
        "about": list(one.about),
        "sentence": one.sentence,
        "evidence": {k: v if math.isfinite(v) else None for k, v in one.evidence.items()},
        "mend": one.mend,
    }


def _channel(one: ChannelInspection) -> dict[str, Any]:
    late = one.clock.received
    return {
        "channel": one.name,
        "as": one.angle,
        "description": one.description or None,
        "quantity": one.guess and one.guess.quantity,
        "known": one.guess and one.guess.words,
        "positive": one.guess and one.guess.positive,
        "unit": one.unit,
        "unit_in_name": one.unit_in_name,
        "samples": one.samples,
        "missing": one.missing,
        "rate": one.rate or None,
        "start_ns": one.start,
        "end_ns": one.end,
        "range": None if math.isnan(one.low) else [one.low, one.high],
        "gaps": {
            "count": one.gaps.count, "total": one.gaps.total, "longest": one.gaps.longest,
        },
        "clock": {
            "words": one.clock.words,
            "jitter": one.clock.jitter,
            "steps_back": one.clock.steps_back,
            "furthest_back": one.clock.furthest_back,
            "same_stamp": one.clock.same,
            "received": late
            and {"offset": late.offset, "drift": late.drift, "jitter": late.jitter},
        },
    }  # fmt: skip
