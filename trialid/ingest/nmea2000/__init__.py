"""NMEA 2000 messages, whatever log they stand in."""

__all__: list[str] = []
