"""Figures of a page."""

__all__: list[str] = []
