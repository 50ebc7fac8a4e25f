"""Tables as logs: CSV and other text, Excel, Parquet, MATLAB."""

__all__: list[str] = []
