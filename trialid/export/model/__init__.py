"""A fitted model as files that others use without trialid: ship file, JSON, NumPy, C, FMU."""

__all__: list[str] = []
