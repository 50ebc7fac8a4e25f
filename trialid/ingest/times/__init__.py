"""Instants from what logs write: GPS weeks, local times."""

__all__: list[str] = []
