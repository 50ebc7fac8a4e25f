"""Steering about a straight course: Nomoto, state space, and the gains of an autopilot."""

__all__: list[str] = []
