"""The stamps of one sensor: what its clock did, its count of samples, and stamps repaired by it."""

__all__: list[str] = []
