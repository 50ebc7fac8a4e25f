"""Templates: how a table is laid out, written down by its owner or drafted from the file."""

__all__: list[str] = []
