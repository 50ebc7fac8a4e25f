"""A fitted model as an FMU of FMI 2.0 or 3.0: what it says, its C source, its binaries."""

__all__: list[str] = []
