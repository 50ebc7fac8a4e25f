"""Logs of autopilots: ArduPilot dataflash and MAVLink telemetry."""

__all__: list[str] = []
