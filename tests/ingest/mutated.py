"""Logs as transfers, cards and disks damage them."""

import random


def mutated(content: bytes, by: random.Random, likeness: bytes) -> bytes:
    """The log damaged in one to five ways; `likeness` is what looks like one of its records."""
    log = bytearray(content)
    for _ in range(by.choice((1, 1, 2, 5))):
        begin = by.randrange(len(log))
        end = min(len(log), begin + by.choice((1, 3, 50, 700, 5000)))
        kind = by.choice(("cut", "flip", "drop", "twice", "noise", "move", "zero", "ones", "like"))
        if kind == "cut":
            end = len(log)
        if kind in {"cut", "drop"}:
            del log[max(begin, 20) : end]
        elif kind == "flip":
            for _ in range(by.choice((1, 10, 100))):
                log[by.randrange(len(log))] ^= 1 << by.randrange(8)
        elif kind in {"zero", "ones"}:
            log[begin:end] = bytes([255 * (kind == "ones")]) * (end - begin)
        elif kind == "move":
            place = by.randrange(len(log))
            log[place : place + end - begin] = log[begin:end]
        else:
            more = {"twice": log[begin:end], "noise": by.randbytes(end - begin)}
            log[begin:begin] = more.get(kind, likeness * by.choice((1, 30)))
    return bytes(log)
