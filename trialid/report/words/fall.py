"""How the error fell over the steps of a history, and what that proves, in words."""

from trialid.names import wording
from trialid.report.pictures.error_history import interval, is_number, step_sentence
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result


def fell(run: Result) -> str:
    """What the picture shows, in words."""
    known = [row for row in run.comparable if is_number(row.eps_rmsn)]
    apart = _apart(run)
    if not known:
        return f"No step has an error.{apart}"
    first, last = known[0], known[-1]
    if first is last:
        return f"One model so far, {step_sentence(last)}.{_zero(last, run)}{apart}"
    words = f"The error goes from {_pair(first, last, 'eps_rmsn')}"
    parts = {"eps_rmsn_check": "held out", "undermodelling": "the model part"}
    for key, word in {**parts, "noise": "the noise part"}.items():
        if is_number(getattr(first, key)) and is_number(getattr(last, key)):
            words += f", {word} from {_pair(first, last, key)}"
    return f"{words}.{_zero(last, run)} {_proof(first, last)}{apart}"


def _apart(run: Result) -> str:
    """Words on steps that other logs were fitted for."""
    others = len(run.history) - len(run.comparable)
    if not others:
        return ""
    return f" {wording.count_of(others, 'earlier step')} had other logs, and other errors for it."


def _proof(first: StepRow, last: StepRow) -> str:
    """What shows that the right effect was added, of what is known."""

    def known(key: str) -> bool:
        return is_number(getattr(first, key)) and is_number(getattr(last, key))

    held_out = known("eps_rmsn_check")
    if known("noise") and known("undermodelling"):
        what = "the model part and the held-out error" if held_out else "the model part"
        return (
            f"The right effect lowers {what} and leaves the noise part as it was: the sea and the "
            "sensors are the same."
        )
    if held_out:
        return "The right effect lowers the held-out error too."
    return (
        "With no trial held out, and noise and model not told apart, a fall alone does not prove "
        "that the effect is the right one."
    )


def _pair(first: StepRow, last: StepRow, key: str) -> str:
    return f"{wording.percent(getattr(first, key))} to {wording.percent(getattr(last, key))}"


def _zero(row: StepRow, run: Result) -> str:
    """What an interval that holds zero means."""
    ends = interval(row, run)
    if ends is None or ends[0] > 0.0:
        return ""
    return (
        " The interval of the model part holds zero: what is left may be noise alone, and a model "
        f"error below {wording.percent(ends[1])} would not be seen."
    )
