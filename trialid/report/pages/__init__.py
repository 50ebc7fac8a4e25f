"""Pages: one run, runs side by side, orders for the bridge."""

__all__: list[str] = []
