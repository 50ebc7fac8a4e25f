"""A reason why a fit carries no verdict."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Inadequate:
    """Why a fit carries no verdict, with its numbers, and what to do next; in words.

    Attributes
    ----------
    may_lack
        Whether what the model lacks may be all that is wrong: a model with it then has no reason.
    """

    reason: str
    advice: str
    may_lack: bool = False

    def __str__(self) -> str:
        """Both on one line."""
        return f"{self.reason}; {self.advice}"
