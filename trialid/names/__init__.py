"""What a signal is called, its unit and its words: the dictionary every part reads."""

__all__: list[str] = []
