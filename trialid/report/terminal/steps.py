"""The steps of a model as rows of a terminal: what was done, and the error with its parts."""

from collections.abc import Iterable, Sequence
from typing import Final

from trialid.names import wording
from trialid.report.terminal.terminal import percent
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result

SHOWN: Final = 8
"""Steps shown of a long history: the last ones."""

_NAME: Final = 26


def heading() -> str:
    """What stands over the rows."""
    return _line("step", ("fitted", "held out", "noise", "model"), "verdict")


def line(step: StepRow) -> str:
    """One step.

    >>> line(StepRow(step="added", added="static_list", eps_rmsn=0.05, eps_rmsn_check=0.06,
    ...              noise=0.04, undermodelling=0.03, verdict="nothing missing"))
    '+ static_list               5.00 %    6.00 %  4.00 %  3.00 %  nothing missing'
    >>> line(StepRow(step="as written", eps_rmsn=0.04, eps_rmsn_check=0.03, noise=0.04,
    ...              undermodelling=0.00091, verdict="nothing missing"))
    'as written                  4.00 %    3.00 %  4.00 % 0.0910 %  nothing missing'
    """
    errors = (step.eps_rmsn, step.eps_rmsn_check, step.noise, step.undermodelling)
    *above, words = _broken(short_words(step))
    return "\n".join([*above, _line(words, [percent(e) for e in errors], step.verdict or "")])


def _broken(words: str) -> list[str]:
    """The words of a step, effects that joined at once below each other."""
    return words.replace(", ", ",\n  ").split("\n")


def rows(run: Result, most: int = SHOWN) -> Iterable[str]:
    """The last steps of a run on its own logs, those apart that were only tried."""
    steps = [step for step in run.comparable if step.step != "proposed"]
    yield heading()
    if others := len(run.history) - len(run.comparable):
        yield f"... {wording.count_of(others, 'earlier step')} on other logs"
    if len(steps) > most:
        yield f"... {wording.count_of(len(steps) - most, 'earlier step')}"
    yield from (line(step) for step in steps[-most:])


def short_words(step: StepRow) -> str:
    """What was done, in few characters.

    >>> short_words(StepRow(step="dropped", dropped="static_list"))
    '- static_list'
    """
    match step.step:
        case "added" | "proposed":
            return f"{step.sign} {step.added}"
        case "dropped":
            return f"- {step.dropped}"
        case other:
            return str(other or "as written")


def _line(name: str, numbers: Sequence[str], words: str) -> str:
    cells = "".join(f" {n:>{width}}" for n, width in zip(numbers, (7, 9, 7, 7), strict=True))
    return f"{name:<{_NAME}}{cells}  {words}".rstrip()
