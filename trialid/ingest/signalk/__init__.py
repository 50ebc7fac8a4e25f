"""Logs of Signal K: a server's own, and deltas alone."""

__all__: list[str] = []
