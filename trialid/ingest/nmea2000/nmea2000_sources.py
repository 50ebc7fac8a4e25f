"""Who sent an NMEA 2000 message: an address can change hands, the NAME of a device cannot.

Devices claim an address with their 64 bit NAME (PGN 60928, ISO 11783-5), at the start and whenever
two want the same. A sender is called by its address as long as that says who it is.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]

ADDRESS_CLAIM = 60928
NO_SENDER = 254
"""Addresses from here on send no data: 254 is `no address yet`, 255 is everyone."""


@dataclass(frozen=True)
class Holder:
    """A device (its NAME, None if it never claimed) at an address; `bus` is 256 times its index."""

    address: int
    name: int | None

    @property
    def device(self) -> tuple[int, int | None]:
        """The bus and NAME of the device; without a NAME the address itself."""
        return (self.address, None) if self.name is None else (self.address // 256, self.name)


@dataclass(frozen=True)
class Senders:
    """Senders of N messages: `of` is the index of each message's into the other two; (N,)."""

    of: Ints
    labels: tuple[str, ...]
    devices: tuple[str, ...]
    remarks: tuple[str, ...]


def name_sources(
    source: Ints, claims: Ints, names: Ints, used: NDArray[np.bool_], buses: Sequence[str] = ()
) -> Senders:
    """Who sent each message.

    Parameters
    ----------
    source
        Address of each message, plus 256 times the index of its bus; (N,).
    claims, names
        Indices of the messages that claim an address, in order, and the NAME in each.
    used
        Which messages will become channels; (N,).
    buses
        Names of the buses where there are several.

    A device that moves to another address keeps the label of its first one. Where two devices
    began at the same address the label of either bears its NAME: `11-C0508C0020A3B2F1`. Before the
    first claim of its address a message is taken for the first claimer's.
    """
    holders: list[Holder] = []
    valid = source[claims] % 256 < NO_SENDER
    claims, names = claims[valid], names[valid]
    alone = np.zeros(int(source.max(initial=0)) + 1, np.int64)
    for address in np.flatnonzero(np.bincount(source)).tolist():
        mine = source[claims] == address
        claimed = names[mine]
        alone[address] = len(holders)
        holders.extend(Holder(address, name) for name in dict.fromkeys(claimed.tolist()))
        if not len(claimed):
            holders.append(Holder(address, None))
    of = alone[source]
    for address in sorted({holder.address for holder in holders if holder.name is not None}):
        mine = source[claims] == address
        if len(np.unique(names[mine])) > 1:
            _change_hands(of, source, address, claims[mine], names[mine], holders)
    return _called(of, holders, used, buses)


def _change_hands(
    of: Ints, source: Ints, address: int, at: Ints, names: Ints, holders: list[Holder]
) -> None:
    """Gives the messages from an address to whoever claimed it last before them."""
    index = {holder.name: i for i, holder in enumerate(holders) if holder.address == address}
    rows = np.flatnonzero(source == address)
    last = np.maximum(np.searchsorted(at, rows, "right") - 1, 0)
    of[rows] = np.array([index[name] for name in names.tolist()])[last]


def _called(
    of: Ints, holders: Sequence[Holder], used: NDArray[np.bool_], buses: Sequence[str]
) -> Senders:
    """Labels of the holders, and remarks on who moved and what changed hands."""
    active = _by_first_use(of, holders, used)
    firsts: dict[tuple[int, int | None], int] = {}
    for holder in active:
        firsts.setdefault(holder.device, holder.address)
    began = list(firsts.values())

    def label(holder: Holder) -> str:
        first = firsts.get(holder.device, holder.address)
        plain = _address(first, buses)
        return plain if began.count(first) < 2 else f"{plain}-{_hex(holder.name)}"

    labels = tuple(label(holder) for holder in holders)
    devices = tuple(
        text if holder.name is None or "-" in text else f"{text} (NAME {_hex(holder.name)})"
        for text, holder in zip(labels, holders, strict=True)
    )
    return Senders(of, labels, devices, tuple(_moves(active, label, firsts, buses)))


def _by_first_use(of: Ints, holders: Sequence[Holder], used: NDArray[np.bool_]) -> list[Holder]:
    """The holders whose messages become channels, in the order of their first one."""
    senders, first = np.unique(of[used], return_index=True)
    return [holders[i] for i in senders[np.argsort(first)].tolist()]


def _moves(
    active: Sequence[Holder],
    label: Callable[[Holder], str],
    firsts: dict[tuple[int, int | None], int],
    buses: Sequence[str],
) -> Iterator[str]:
    for address in dict.fromkeys(holder.address for holder in active):
        owners = [holder for holder in active if holder.address == address]
        if len(owners) > 1:
            names = " and ".join(label(holder) for holder in owners)
            place = _address(address, buses)
            yield f"address {place} changed hands in this log: its devices are {names}"
    for holder in active:
        first = firsts[holder.device]
        if holder.address != first:
            places = f"{_address(first, buses)} to {_address(holder.address, buses)}"
            name = f"device {_hex(holder.name)} moved from address {places}"
            yield f"{name}: its channels are those of source {label(holder)}"


def _address(address: int, buses: Sequence[str]) -> str:
    return f"{buses[address // 256]}.{address % 256}" if buses else str(address)


def _hex(name: int | None) -> str:
    return "no NAME" if name is None else f"{name & 0xFFFF_FFFF_FFFF_FFFF:016X}"
