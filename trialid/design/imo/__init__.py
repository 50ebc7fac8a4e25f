"""IMO's standard measures and turning circles, of the model and of a record, with their ranges."""

__all__: list[str] = []
