"""Which trial to run next: manoeuvres sailed by simulation, rated by sensitivity, optimised."""

__all__: list[str] = []
