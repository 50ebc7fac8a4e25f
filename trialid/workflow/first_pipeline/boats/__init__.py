"""Boats that steer by what drives them: two thrusters or two pods."""

__all__: list[str] = []
