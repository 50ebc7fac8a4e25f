"""The track of a trial: positions in a plane, the antenna, and what contradicts them."""

__all__: list[str] = []
