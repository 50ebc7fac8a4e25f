"""What a fitted ship will do under orders, with where it is likely to lie, and what was seen."""

__all__: list[str] = []
