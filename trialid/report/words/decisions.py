"""What a person has to decide before a log can be fitted, in words with the evidence."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.agreement.slopes import LATE
from trialid.inspection.disagreements import COMPARED, MOST_SOURCES
from trialid.inspection.drives import drives_of
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.relations import side
from trialid.names import labels

ALIKE: Final = 0.95
"""Correlation of two channels that hold one motion, so that their clocks can be matched by it."""


def decisions(
    known: Mapping[str, Sequence[ChannelInspection]], found: Sequence[Finding], survey: Inspection
) -> Sequence[str]:
    """Several sources, none at all, no unit, a rudder's side; `known` are sources by quantity."""
    return [
        *_several(known, found),
        *_clocks_apart(found, len(survey.files)),
        *_mends(found),
        *_lacking(known, drives_of(survey)),
        *_unitless(known),
        *_rudder(known),
    ]


def _several(
    known: Mapping[str, Sequence[ChannelInspection]], found: Sequence[Finding]
) -> Iterator[str]:
    """Several sources of a quantity, and what sets them apart."""
    for name in COMPARED:
        live = [one for one in known.get(name, ()) if not one.constant]
        if len(live) < 2:
            continue
        rates = ", ".join(f"{one.key} {one.rate:.3g} Hz" for one in live[:MOST_SOURCES])
        more = f" and {len(live) - MOST_SOURCES} more" if len(live) > MOST_SOURCES else ""
        keys = {one.key for one in live}
        apart = [one.sentence for one in found if one.kind == "differ" and keys >= {*one.about}]
        yield f"{len(live)} sources of {labels.label(name)}: {rates}{more}"
        yield from apart


def _clocks_apart(found: Sequence[Finding], files: int) -> Iterator[str]:
    """What to do where a shift may be that of two recorders' clocks."""
    late = [
        one
        for one in found
        if one.kind == "differ"
        and abs(one.evidence.get("lag", 0.0)) > LATE
        and one.evidence["correlation"] > ALIKE
    ]
    if files > 1 and late:
        here, there = late[0].about
        yield (
            "if those are logs of two recorders: name the files apart in `logs`, and write beside "
            f'the path of the one that holds {here}: clock = {{ match = ["{here}", "{there}"] }}'
        )


def _mends(found: Sequence[Finding]) -> Iterator[str]:
    """What a line of the pipeline would mend; of a rudder's side `_rudder` tells more."""
    for one in found:
        if one.mend is not None and one.kind != "side":
            yield one.words


def _lacking(
    known: Mapping[str, Sequence[ChannelInspection]], drives: Sequence[ChannelInspection]
) -> Iterator[str]:
    alive = {name for name, sources in known.items() if any(not one.constant for one in sources)}
    if not alive & {"delta", "delta_order"} and len(drives) == 2:
        port, starboard = (one.key for one in drives)
        yield f"no rudder moves; {port} and {starboard} seem to drive her: `trialid start` tries"
    elif not alive & {"delta", "delta_order"}:
        yield "no rudder or rudder order that moves is recognised: all but roll decays need one"
    if not alive & {"r", "psi", "phi"}:
        yield "no yaw rate, heading or roll angle that moves is recognised: a fit needs a motion"
    if "u" not in alive:
        yield "no speed through the water that moves is recognised: state `speed` in the pipeline"


def _unitless(known: Mapping[str, Sequence[ChannelInspection]]) -> Iterator[str]:
    """Channels whose unit the log does not tell: a pipeline has to."""
    bare = [
        one.key
        for sources in known.values()
        for one in sources
        if not one.constant and not one.stated_unit
    ]
    if bare:
        more = f" and {len(bare) - MOST_SOURCES} more" if len(bare) > MOST_SOURCES else ""
        names = ", ".join(bare[:MOST_SOURCES]) + more
        yield f"no unit is stated for {names}: `unit` in the pipeline has to say it"


def _rudder(known: Mapping[str, Sequence[ChannelInspection]]) -> Iterator[str]:
    """What the motion says about the sign of each rudder; the best yaw rate is the witness."""
    witness = next((one for one in known.get("r", ()) if not one.constant), None)
    if witness is None:
        return
    for name in ("delta", "delta_order"):
        for one in known.get(name, ())[:3]:
            found = side(one, witness)
            if found is not None:
                yield (
                    f'{one.key}: positive = "{found.side}", by its correlation with {found.by}, of '
                    f"{witness.key} ({found.strength:+.2f}), if that is positive to {found.if_to}"
                )
