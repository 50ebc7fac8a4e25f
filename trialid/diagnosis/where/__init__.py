"""What a fit leaves over, cut in slices: by time, amplitude, side, heading, speed, frequency."""

__all__: list[str] = []
