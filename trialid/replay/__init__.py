"""A recorded log played back through the same chain, at its own pace or faster."""

__all__: list[str] = []
