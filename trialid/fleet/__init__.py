"""Many runs as one piece of work: planned from a fleet file, done by Dask, told as tables."""

__all__: list[str] = []
