"""Whether the signals of a trial agree: rates with angles, signs with each other, twin channels."""

__all__: list[str] = []
