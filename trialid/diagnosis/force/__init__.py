"""The force that is missing: when it acts, on what it depends, which shape it has."""

__all__: list[str] = []
