"""From a pipeline to a finished run, and from one run to the next."""

__all__: list[str] = []
