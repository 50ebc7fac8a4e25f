"""The workflow in a notebook or a script: runs that show themselves, with and without files."""

__all__: list[str] = []
