"""What is special about roll: a resonance that a record may not show, and what ships have."""

__all__: list[str] = []
