"""What the records themselves leave in doubt: a side, a delay, what nobody logged."""

__all__: list[str] = []
