"""A programme of trials designed for a ship, and its folder."""

__all__: list[str] = []
