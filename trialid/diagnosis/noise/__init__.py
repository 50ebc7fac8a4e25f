"""What the error is made of: noise, and what the model cannot do."""

__all__: list[str] = []
