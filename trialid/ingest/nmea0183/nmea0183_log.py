r"""NMEA 0183 logs: lines of sentences, with or without stamps before them.

What recorders write before a sentence is understood as far as it is a time or a tag block: ISO
dates, seconds or milliseconds since 1970, times of day, `\s:..,c:..*hh\`, `UdPbC` datagrams (IEC
61162-450), and the CSV of OpenCPN's Data Monitor (`received_at,protocol,source,msg_type,raw_data`,
whose header names two columns the wrong way round in some releases: the rows decide).
"""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.nmea0183 import nmea0183_recorded
from trialid.ingest.nmea0183.nmea0183_columns import texts
from trialid.ingest.nmea0183.nmea0183_sentences import Places, Sentences, Span
from trialid.recording import Recording

TEXT = frozenset(range(32, 127)) | {9, 10, 13, 0}
PRINTABLE = 0.9
"""Share of a head's bytes that are text."""
SENTENCE = re.compile(
    rb"[$!](?P<address>[A-Z][A-Z0-9]{2,9})(?=[,*])[^$!\r\n]*(?P<sum>\*[0-9A-Fa-f]{2})?"
)
NOT_OURS = re.compile(rb"[$!](PCDIN|MXPGN|PDGY|PYDWG)")
"""NMEA 2000 in the clothes of a sentence."""
SIGNAL_K = re.compile(rb"\d{12,14};[A-Za-z];")
OPENCPN = re.compile(rb"^[^\n,]*,\s*NMEA(0183|2000)\s*,", re.MULTILINE)


def recognises(head: bytes) -> bool:
    """Text of which most lines hold a sentence, and which is no log of Signal K."""
    if not head or sum(byte in TEXT for byte in head) < PRINTABLE * len(head):
        return False
    lines = head.splitlines()
    lines = lines[:-1] if len(lines) > 1 and not head.endswith((b"\n", b"\r")) else lines
    lines = [line for line in lines if line.strip() and not line.startswith((b"#", b";"))]
    if SIGNAL_K.match(lines[0] if lines else b""):
        return False
    ours = [line for line in lines if SENTENCE.search(line) and not NOT_OURS.search(line)]
    return len(ours) > 0 and (len(ours) >= 0.5 * len(lines) or OPENCPN.search(head) is not None)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; sentences with a wrong checksum are left out and counted.

    Raises LogError when no sentence is sound, and when nothing in the log says the time.
    """
    with path.open("rb") as file:
        opencpn = OPENCPN.search(file.read(4096)) is not None
    found, remarks = nmea0183_recorded.channels(
        path,
        lambda: nmea0183_recorded.blocks(path),
        wanted,
        aids.zone,
        _connections if opencpn else None,
    )
    if opencpn:
        others = sum(part.count(b",NMEA2000,") for part in nmea0183_recorded.blocks(path))
        remarks += [f"{others} lines of NMEA 2000 left out; log that bus as CAN"] if others else []
    return Recording(path, ADAPTER.name, sha256(path), found, tuple(remarks))


def _connections(block: Sentences) -> Iterator[tuple[Places, str]]:
    """OpenCPN's source of each row: the third or fourth column, the other names the sentence."""
    first = np.searchsorted(block.comma, block.before.a)
    count = np.searchsorted(block.comma, block.before.b) - first
    rows = np.flatnonzero(count >= 4)
    for third, text in texts(block.data, _column(block, first[rows], 1)):
        part = rows[third]
        if not len(part):
            continue
        address = block.data[block.body.a[part[0]] : block.body.b[part[0]]].tobytes()[:5].decode()
        if text.strip('"') and text.strip('"') in (address, address[2:]):
            for fourth, source in texts(block.data, _column(block, first[part], 2)):
                yield part[fourth], source
        else:
            yield part, text


def _column(block: Sentences, first: Places, number: int) -> Span:
    """Column 2 and on of the rows whose first comma is given, by index."""
    return Span(block.comma[first + number] + 1, block.comma[first + number + 1])


ADAPTER = Adapter("nmea0183", recognises, read, frozenset({"zone"}))
