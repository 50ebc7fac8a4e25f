"""Which effect is missing: every candidate tried by linear algebra, the best fitted."""

__all__: list[str] = []
