"""Eq. 2 to 7: the parameters with the smallest output error."""

__all__: list[str] = []
