"""Payloads in one stretch of bytes, as they lie in a log."""

import numpy as np

from trialid.ingest.mcap.payload import Payloads


def packed(payloads: list[bytes]) -> Payloads:
    """The payloads with a byte that belongs to nobody before each."""
    data = np.frombuffer(b"".join(b"?" + payload for payload in payloads), np.uint8)
    size = np.array([len(payload) for payload in payloads], np.int64)
    return Payloads(data, np.cumsum(size + 1) - size, size)
