"""The steps of a model: what each changed, and the rows that show them."""

__all__: list[str] = []
