"""Whole model structures compared: which there are, their fits, the one to take."""

__all__: list[str] = []
