"""What a trial that is not fitted has for itself: where it starts, and how sure that is."""

__all__: list[str] = []
