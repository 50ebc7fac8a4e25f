"""A survey of a log as a person reads it in a terminal.

Names of channels come from files that anybody may have written: they are shown as plain text, and
what could steer a terminal is shown escaped.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.clocks import CALENDAR_NS, moment
from trialid.errors import printable
from trialid.inspection.disagreements import findings
from trialid.inspection.inspected import ChannelInspection, Inspection, Received
from trialid.inspection.positions import position_words
from trialid.names import labels, wording
from trialid.names.quantities import SIGNALS
from trialid.recording import ZONELESS
from trialid.report.terminal.terminal import Words, add_row, cut, new_table
from trialid.report.words.decisions import decisions

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderResult
    from rich.measure import Measurement
    from rich.table import Table

MOST_MESSAGES: Final = 12
"""Messages without a recognised field that are listed before they are only counted."""
NARROW, DESCRIBED = 24, 46
"""Columns of a channel's name on the narrowest terminal, and of what is said below a short one."""
DEGREES: Final = {"rad": "deg", "rad/s": "deg/s"}
"""People think in degrees."""
MOST_REMARKS: Final = 8


def inspection(survey: Inspection, *, everything: bool = False) -> Sequence[Any]:
    """The survey as lines and tables to print in order; `everything` folds nothing."""
    known, found = _by_quantity(survey), findings(survey)
    parts: list[Any] = [_title(survey), ""]
    if known:
        parts += [_signals(known), ""]
    parts += [
        *_choices(decisions(known, found, survey)),
        *_others(survey, everything),
        *_clocks(survey),
    ]
    parts += _remarks(survey, found)
    return parts[:-1] if parts[-1] == "" else parts


def _by_quantity(survey: Inspection) -> dict[str, tuple[ChannelInspection, ...]]:
    """Sources of each recognised quantity, in the order of the dictionary."""
    found = {name: survey.sources(name) for name in SIGNALS}
    return {name: sources for name, sources in found.items() if sources}


def _title(survey: Inspection) -> Any:
    from rich.text import Text

    count = len(survey.channels)
    files = f", {len(survey.files)} files" if len(survey.files) > 1 else ""
    facts = f"{survey.format}{files}, {count} channel{'s' if count > 1 else ''}, {_span(survey)}"
    return Text(f"{printable(str(survey.path))}\n", style="bold").append(facts, style="not bold")


def _span(survey: Inspection) -> str:
    """How long it is and from when to when, of channels on two clocks for each clock."""
    unstated = any(ZONELESS in one.clock.words for one in survey.channels.values())
    zone = "as written, no zone is given" if unstated else "UTC"
    words = [_between(*span, zone) for span in survey.spans]
    return words[0] if len(words) == 1 else f"two clocks: {'; '.join(words)}"


def _between(first: int, last: int, zone: str) -> str:
    shown, of = (_date, f" {zone}") if first > CALENDAR_NS else (moment, "")
    return f"{(last - first) / 1e9:.1f} s, {shown(first)} to {shown(last)}{of}"


def _date(stamp: int) -> str:
    return moment(stamp).replace("T", " ").partition(".")[0]


def _signals(known: dict[str, tuple[ChannelInspection, ...]]) -> "Table":
    """A heading a quantity, its sources below it side by side."""
    from rich.text import Text

    table = new_table("channel", "known", "Hz", "gaps", "from", "to", "unit", words=2)
    table.columns[0].no_wrap, table.columns[0].overflow = False, "fold"
    table.columns[6].justify = "left"
    for name, sources in known.items():
        table.add_row(Text(labels.label(name), style="bold"))
        for one in sources:
            cells = (_how(one), *_numbers(one))
            style = "dim" if one.constant else ""
            table.add_row(
                _Source(printable(one.key), printable(one.description.replace(f" {one.name}", ""))),
                *(Text(cell) for cell in cells),
                style=style,
            )
    return table


@dataclass(frozen=True)
class _Source:
    """What a pipeline writes, and below it what the format says of it."""

    name: str
    description: str

    def __rich_measure__(self, console: "Console", options: "ConsoleOptions") -> "Measurement":
        """As wide as the name; the description has the room that is there."""
        from rich.measure import Measurement

        longest = 2 + max(len(self.name), min(len(self.description), DESCRIBED))
        return Measurement(min(NARROW, longest), longest)

    def __rich_console__(self, console: "Console", options: "ConsoleOptions") -> "RenderResult":
        """A name too long is broken after a separator, where that is possible."""
        from rich.padding import Padding
        from rich.text import Text

        room = max(options.max_width - 2, 1)
        text = Text(_broken(self.name, room))
        if self.description:
            text.append(f"\n{cut(self.description, 2, max(room, len(' ...') + 1))}", style="dim")
        yield Padding(text, (0, 0, 0, 2))


def _broken(name: str, width: int) -> str:
    r"""A name on lines of that width, broken after `/`, `:`, `.` or `_`.

    >>> _broken("pubsub/yaw_rate/gyro:value", 18)
    'pubsub/yaw_rate/\ngyro:value'
    """
    lines = [""]
    for part in re.findall(r"[^/:._]*[/:._]|[^/:._]+$", name):
        if len(lines[-1]) + len(part) > width and lines[-1]:
            lines.append("")
        lines[-1] += part
    return "\n".join(lines)


def _how(one: ChannelInspection) -> str:
    """How a quantity is known, in a word."""
    assert one.guess is not None
    return f"by {one.guess.how}"


def _numbers(one: ChannelInspection) -> tuple[str, str, str, str, str]:
    holes = f"{one.gaps.count}\n{one.gaps.total:.3g} s" if one.gaps.count else "-"
    return f"{one.rate:.3g}", holes, *_range(one), _unit(one)


def _range(one: ChannelInspection) -> tuple[str, str]:
    if math.isnan(one.low):
        return "not", "available"
    times = math.degrees(1.0) if _in_degrees(one) else 1.0
    if one.constant:
        return "always", f"{times * one.low:.4g}"
    return f"{times * one.low:.4g}", f"{times * one.high:.4g}"


def _in_degrees(one: ChannelInspection) -> str | None:
    """The unit that an angle or a turning of the ship is shown in, instead of radians."""
    return DEGREES.get(one.stated_unit or "") if one.guess is not None else None


def _unit(one: ChannelInspection) -> str:
    if degrees := _in_degrees(one):
        return f"{degrees}\nlog {one.stated_unit}"
    if one.unit:
        return printable(one.unit)
    return f"{one.unit_in_name} (name)" if one.unit_in_name else "not stated"


def _choices(lines: Sequence[str]) -> Iterator[Any]:
    """What a person has to decide."""
    if lines:
        yield _heading("to decide")
        yield from (_bullet(line) for line in lines)
        yield ""


def _others(survey: Inspection, everything: bool) -> Iterator[Any]:
    rest = [one for one in survey.channels.values() if one.guess is None]
    if not rest:
        return
    yield _heading(f"other channels: {len(rest)}")
    if everything:
        yield _all_others(rest)
    else:
        yield from _folded(rest)
    yield ""


def _all_others(rest: Sequence[ChannelInspection]) -> "Table":
    table = new_table("channel", "Hz", "gaps", "from", "to", "unit", words=1)
    table.columns[0].overflow, table.columns[0].no_wrap = "fold", False
    table.columns[5].justify = "left"
    for one in rest:
        cells = (cell.replace("\n", ", ") for cell in _numbers(one))
        add_row(table, printable(one.key), *cells)
    return table


def _folded(rest: Sequence[ChannelInspection]) -> Iterator[Any]:
    """One line a message; columns of a table have none and stand in one line together."""
    groups: dict[str, list[ChannelInspection]] = {}
    for one in rest:
        groups.setdefault(one.message, []).append(one)
    table = new_table("message", "Hz", "fields", words=1)
    table.columns[2].justify, table.columns[2].ratio, table.expand = "left", 1, True
    table.columns[0].max_width = 44
    for message, fields in list(groups.items())[:MOST_MESSAGES]:
        names = ", ".join(one.key.removeprefix(f"{message}:") for one in fields)
        add_row(table, printable(message) or "(columns)", f"{fields[0].rate:.3g}", printable(names))
    yield table
    left = len(groups) - MOST_MESSAGES
    if left > 0:
        yield Words(
            f"and {wording.count_of(left, 'more message')}; --all shows every channel", 1, "dim"
        )


def _clocks(survey: Inspection) -> Iterator[Any]:
    """One line a clock, with the worst of the messages it stamps."""
    recognised = [one for one in survey.channels.values() if one.guess is not None]
    groups: dict[str, list[ChannelInspection]] = {}
    for one in recognised or survey.channels.values():
        groups.setdefault(one.clock.words, []).append(one)
    table = new_table("clock", "of", "jitter, of period", "steps back", "recorder later", words=2)
    for column in table.columns[:2]:
        column.overflow, column.no_wrap = "fold", False
    for words, group in groups.items():
        messages = list(dict.fromkeys(one.message or "table" for one in group))
        more = f" and {len(messages) - 3} more" if len(messages) > 3 else ""
        names = printable(", ".join(messages[:3])) + more
        add_row(table, printable(words) or "not stated", names, *_worst(group))
    yield _heading("clocks")
    yield table
    yield ""


def _worst(group: Sequence[ChannelInspection]) -> tuple[str, str, str]:
    """Jitter as a share of the period, steps back, and how much later the recorder is."""
    jitter = max(100 * one.clock.jitter * one.rate for one in group)
    back = max(group, key=lambda one: one.clock.steps_back).clock
    late = [one.clock.received for one in group if one.clock.received is not None]
    return (
        f"{jitter:.2g} %" if jitter >= 0.01 else "0 %",
        f"{back.steps_back} (to {back.furthest_back:.4g} s)" if back.steps_back else "-",
        _against(late)
        if all(one.same_epoch for one in group if one.clock.received)
        else "another date",
    )


def _against(late: Sequence[Received]) -> str:
    """How much later than the stamps the recorder is."""
    offsets = [one.offset for one in late]
    return f"{min(offsets):.3g} to {max(offsets):.3g} s" if offsets else "-"


def _remarks(survey: Inspection, found: Sequence[Finding]) -> Iterator[Any]:
    several = len(survey.files) > 1
    said = [
        f"{file.path.name}: {remark}" if several else remark
        for file in survey.files
        for remark in file.remarks
    ]
    said += [one.sentence for one in found if one.mend is None and one.kind != "differ"]
    said += position_words(survey.channels.values())
    for title, lines in (("noticed", said), ("careful", list(survey.warnings))):
        if lines:
            yield _heading(title)
            yield from (_bullet(line) for line in lines[:MOST_REMARKS])
            if len(lines) > MOST_REMARKS:
                yield Words(f"and {len(lines) - MOST_REMARKS} more; --json has them all", 1, "dim")
            yield ""


def _bullet(line: str) -> Any:
    """A sentence behind a dash, its further lines indented."""
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    grid = Table.grid(padding=(0, 1))
    grid.add_row(Text("-"), Padding(Text(printable(line)), 0))
    return grid


def _heading(text: str) -> Any:
    from rich.text import Text

    return Text(text, style="bold")
