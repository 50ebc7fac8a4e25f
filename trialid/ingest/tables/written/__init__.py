"""Numbers that a table has as text, with the side they are to."""

__all__: list[str] = []
