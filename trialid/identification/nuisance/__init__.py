"""What each trial has for itself and what is known of it beforehand."""

__all__: list[str] = []
