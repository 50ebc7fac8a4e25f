"""What is found about the channels of a trial, as data; what no fit could live with is refused."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from trialid.errors import AlignmentError

Severity = Literal["error", "remark"]


@dataclass(frozen=True)
class Finding:
    """Something about the channels that a user should know.

    Parameters
    ----------
    kind
        `unit`, `scale`, `unrelated`, `sign`, `axes`, `side`, `lag`, `differ`, `heel` or `still`.
    severity
        `error` where no fit could be right, else `remark`.
    about
        Quantities or channels it is about.
    sentence
        In words, one line.
    evidence
        Its figures, in SI.
    mend
        The line of a pipeline's signal that would mend it, where it is known; of the first that it
        is about, and of a lag of the later one.
    """

    kind: str
    severity: Severity
    about: tuple[str, ...]
    sentence: str
    evidence: Mapping[str, float] = field(default_factory=dict)
    mend: str | None = None

    def of_slope(self, rate: str) -> bool:
        """Whether it says that a rate comes at another time than its angle, or is not its slope."""
        told = self.kind in ("lag", "scale", "drift") and self.severity == "remark"
        return told and self.about[0] == rate

    @property
    def words(self) -> str:
        """The sentence with the line that would mend it, where it does not name it already."""
        if self.mend is None or self.mend in self.sentence:
            return self.sentence
        first, *others = self.about
        later = others[0] if self.kind == "lag" and self.evidence["lag"] < 0.0 else first
        return f"{self.sentence}; {self.mend} in {later} would mend it"


def refuse(findings: Sequence[Finding], where: str) -> None:
    """AlignmentError for the first finding that is an error."""
    for one in findings:
        if one.severity == "error":
            raise AlignmentError(f"{where}: {one.sentence}")
