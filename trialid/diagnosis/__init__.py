"""What is missing in a model: noise against model error, where it fails, which effect."""

__all__: list[str] = []
