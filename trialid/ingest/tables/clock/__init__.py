"""The clock of a table: which column it is, and stamps from what stands there."""

__all__: list[str] = []
