"""Sentences that pages and terminal share."""

__all__: list[str] = []
