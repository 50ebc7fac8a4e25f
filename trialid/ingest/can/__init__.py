"""Logs of CAN buses: candump, ASC, BLF, TRC, SQLite, CSV, canboat; what a DBC file says of them."""

__all__: list[str] = []
