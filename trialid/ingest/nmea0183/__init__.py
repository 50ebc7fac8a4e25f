"""Logs of NMEA 0183 sentences."""

__all__: list[str] = []
