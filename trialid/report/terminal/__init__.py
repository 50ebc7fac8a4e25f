"""What the terminal shows."""

__all__: list[str] = []
