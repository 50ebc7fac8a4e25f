"""A CAN bus that is listened to: its frames as a candump log that grows, to be followed."""

import logging
import time
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, TextIO

from trialid.errors import TrialidError, nearest, reason_of

if TYPE_CHECKING:
    import can

PREFIX: Final = "can:"
NMEA_2000_RATE: Final = 250_000
"""Bits a second of every NMEA 2000 bus."""
NAME: Final = "can0"
"""What the log calls the bus; channels of a driver may have names that no candump has."""


@dataclass(frozen=True)
class Address:
    """A bus as python-can names it: `socketcan`, `pcan`, `slcan`, ... and the driver's channel."""

    interface: str
    channel: str

    def __str__(self) -> str:
        return f"{PREFIX}{self.interface}:{self.channel}"


def address(text: str) -> Address:
    """The bus that `can:INTERFACE:CHANNEL` names; the channel may have colons itself.

    >>> address("can:socketcan:can0")
    Address(interface='socketcan', channel='can0')

    Raises
    ------
    TrialidError
        It is not of that form.
    """
    interface, _, channel = text.removeprefix(PREFIX).partition(":")
    if not text.startswith(PREFIX) or not interface or not channel:
        raise TrialidError(
            f"--follow {text}: a bus is can:INTERFACE:CHANNEL, as can:socketcan:can0 or "
            "can:pcan:PCAN_USBBUS1"
        )
    return Address(interface, channel)


class LiveBus:
    """Writes every frame of a bus to a candump log as it comes; sends none.

    Parameters
    ----------
    at
        The bus.
    log
        The file to write, replaced if it is there.
    bit_rate
        Of the bus [bit/s] where python-can's own configuration states none; None: the driver's.

    Raises
    ------
    TrialidError
        There is no such interface, its driver is not here, the channel cannot be opened, or the
        log cannot be written.
    """

    def __init__(self, at: Address, log: Path, bit_rate: int | None = NMEA_2000_RATE) -> None:
        self.at, self.log, self.frames = at, log, 0
        self._bus = _opened(at, bit_rate)
        try:
            self._file: TextIO = log.open("w", encoding="ascii", buffering=1)
        except OSError as error:
            self._bus.shutdown()
            raise TrialidError(f"{log}: cannot be written ({error.strerror})") from error
        self._notifier = _listening(self._bus, self._file, self._count)

    def __enter__(self) -> "LiveBus":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        self._notifier.stop(timeout=2.0)
        self._bus.shutdown()
        self._file.close()

    @property
    def trouble(self) -> str:
        """Why no more frames come, empty where none is known: the adapter was pulled out."""
        error = self._notifier.exception
        return "" if error is None else reason_of(error)

    def _count(self) -> None:
        self.frames += 1


def _opened(at: Address, bit_rate: int | None) -> "can.BusABC":
    import can

    logging.getLogger("can").addHandler(logging.NullHandler())  # its warnings are told as errors
    if at.interface not in can.VALID_INTERFACES:
        known = nearest(at.interface, sorted(can.VALID_INTERFACES))
        raise TrialidError(f"--follow {at}: python-can has no interface {at.interface!r}; {known}")
    try:
        config: dict[str, Any] = dict(
            can.util.load_config(config={"interface": at.interface, "channel": at.channel})
        )
        if bit_rate is not None and "timing" not in config:
            config.setdefault("bitrate", bit_rate)
        return can.Bus(ignore_config=True, **config)
    except TypeError as error:
        raise TrialidError(
            f"--follow {at}: {reason_of(error)}; state what the driver needs in python-can's "
            "configuration (can.ini)"
        ) from error
    except (can.CanError, ImportError, OSError, ValueError) as error:
        raise TrialidError(
            f"--follow {at}: the bus cannot be opened, {reason_of(error)}; install the driver of "
            "the interface, and look up the name of the channel"
        ) from error


def _listening(bus: "can.BusABC", file: TextIO, count: Any) -> "can.Notifier":
    """Writes what comes, in a thread of its own."""
    import can

    writer = can.CanutilsLogWriter(file)

    def take(message: can.Message) -> None:
        message.channel = NAME
        message.timestamp = message.timestamp or time.time()
        writer.on_message_received(message)
        count()

    return can.Notifier(bus, [take])
