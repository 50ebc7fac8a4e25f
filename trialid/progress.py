"""What a long piece of work tells while it runs."""

from collections.abc import Callable

Progress = Callable[[str, float | None], None]
"""Takes words and the share that is done, None where nobody knows."""


def silent(words: str, share: float | None = None) -> None:
    """Progress that nobody watches."""
