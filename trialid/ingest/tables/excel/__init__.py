"""Excel workbooks: their sheets, guarded against what would take all memory."""

__all__: list[str] = []
