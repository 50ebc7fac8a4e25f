"""Reading bytes that several formats share: growing files, damaged records, fields of text."""

__all__: list[str] = []
