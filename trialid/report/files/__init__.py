"""Files beside the report: series, recordings, tables of a test."""

__all__: list[str] = []
