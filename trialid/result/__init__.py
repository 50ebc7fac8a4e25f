"""The result of a run: `result.json`, its schema and its time series."""

__all__: list[str] = []
