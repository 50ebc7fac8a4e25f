"""Eq. 2: the response of a model and its sensitivities, traced, compiled, integrated."""

__all__: list[str] = []
