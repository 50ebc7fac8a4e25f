"""The ship model: particulars, masses, effects, motion."""

__all__: list[str] = []
