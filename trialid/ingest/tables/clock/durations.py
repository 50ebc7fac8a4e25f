"""Times since a beginning as programs write them: MATLAB `0.5 sec`, pandas `0 days 00:00:00.5`.

`01:30.5` can be nothing but minutes and seconds, and of `08:00:01:250` the last are thousandths; a
whole `01:30` may be hours and minutes, and is none of these.
"""

import re
from collections.abc import Sequence
from typing import Final

from trialid.errors import UnitError
from trialid.names import units

COUNTED: Final = re.compile(
    r"\A(?P<count>[+-]?\d++(?:\.\d*+)?(?:[eE][+-]?\d+)?)\s*+(?P<unit>[a-z]++)"
)
CLOCKS: Final = (
    re.compile(
        r"\A(?P<days>\d++) days? \+?(?P<hours>\d\d?):(?P<minutes>\d\d):"
        r"(?P<seconds>\d\d(?:\.\d++)?)"
    ),
    re.compile(r"(?P<minutes>\d{1,4}):(?P<seconds>\d\d[.,]\d++)"),
    re.compile(r"(?P<hours>\d\d?):(?P<minutes>\d\d):(?P<seconds>\d\d:\d{3})"),
)
SECONDS_IN: Final = {"days": 86_400, "hours": 3600, "minutes": 60, "seconds": 1}


def in_seconds(texts: Sequence[str]) -> list[float] | None:
    """All texts as seconds; None where one is none, or they are not written alike.

    >>> in_seconds(["0 sec", "0.5 sec"]), in_seconds(["1 min", "2 min"]), in_seconds(["5 kn"])
    ([0.0, 0.5], [60.0, 120.0], None)
    >>> in_seconds(["1 days 00:00:01.5"]), in_seconds(["01:30.5"]), in_seconds(["08:00:01:250"])
    ([86401.5], [90.5], [28801.25])
    >>> in_seconds(["01:30"]), in_seconds(["0 sec", "1 min"]), in_seconds(["08:00:01"])
    (None, None, None)
    """
    plain = [text.strip() for text in texts]
    for form in (COUNTED, *CLOCKS):
        found = [form.fullmatch(text) for text in plain]
        alike = [one for one in found if one is not None]
        if alike and len(alike) == len(found):
            return _counted(alike) if form is COUNTED else [*map(_of_clock, alike)]
    return None


def _counted(found: Sequence[re.Match[str]]) -> list[float] | None:
    names = {one["unit"] for one in found}
    if len(names) > 1:
        return None
    try:
        size = units.factor(names.pop(), "s")
    except UnitError:
        return None
    return [float(one["count"]) * size for one in found]


def _of_clock(one: re.Match[str]) -> float:
    parts = one.groupdict(default="0")
    parts["seconds"] = re.sub("[,:]", ".", parts["seconds"])
    return sum(SECONDS_IN[name] * float(text) for name, text in parts.items())
