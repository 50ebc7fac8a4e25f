"""The fitted model in use: taken up again from its run's folder, simulated, handed over."""

__all__: list[str] = []
