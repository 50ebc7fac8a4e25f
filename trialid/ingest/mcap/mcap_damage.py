"""What was lost of a damaged MCAP file, in words."""

from collections.abc import Iterator
from datetime import UTC, datetime

from trialid.ingest.mcap.mcap_records import Book

DATED = (631_152_000_000_000_000, 4_102_444_800_000_000_000)
"""Stamps between 1990 and 2100 [ns] count from 1970; others from wherever the clock began."""
SHOWN = 3
"""Spans that are named; of more the rest is counted."""


def remarks(book: Book) -> Iterator[str]:
    """The remarks a reader owes to whoever uses what was recovered."""
    promised = book.summary.promised
    if book.losses:
        yield _recovered(book)
    elif promised is not None and promised != book.seen:
        yield f"{book.seen} messages found where the file's statistics count {promised}"
    if book.repeated:
        yield f"{book.repeated} chunks stand twice in the file and are read once"
    if book.unprotected or not (book.chunked or book.checked):
        yield "the messages carry no checksum: damage inside them would not be seen"


def _recovered(book: Book) -> str:
    """How much was read nevertheless, what was lost, where and why."""
    loss = book.losses[0]
    more = f" and {len(book.losses) - 1} more" if len(book.losses) > 1 else ""
    return (
        f"recovered {book.seen}{_total(book)} messages, {_lost(book)}; "
        f"damaged at byte {loss.at} ({loss.reason}){more}"
    )


def _total(book: Book) -> str:
    """How many there were: what the statistics say, else what the lost chunks' indexes say."""
    if book.summary.promised is not None:
        return f" of {book.summary.promised}"
    counted = sum(loss.count for loss in book.losses)
    return f" of about {book.seen + counted}" if counted else ""


def _lost(book: Book) -> str:
    if book.summary.promised is not None and book.summary.promised <= book.seen:
        return "lost none"
    spans = [loss.span for loss in book.losses if loss.span]
    if not spans:
        return "the time lost is not known"
    more = f" and {len(spans) - SHOWN} more spans" if len(spans) > SHOWN else ""
    return "lost " + ", ".join(span_words(*span) for span in spans[:SHOWN]) + more


def span_words(first: int, last: int) -> str:
    """Two times [ns]: as dates where they count from 1970, else in seconds.

    >>> span_words(1_700_000_846_000_000_000, 1_700_000_875_500_000_000)
    '2023-11-14 22:27:26-22:27:55'
    >>> span_words(12_000_000_000, 13_500_000_000)
    '12.00-13.50 s'
    """
    if not DATED[0] <= first <= last < DATED[1]:
        return f"{first / 1e9:.2f}-{last / 1e9:.2f} s"
    begin, end = (datetime.fromtimestamp(t // 1_000_000_000, UTC) for t in (first, last))
    same_day = begin.date() == end.date()
    return f"{begin:%Y-%m-%d %H:%M:%S}-{end:{'%H:%M:%S' if same_day else '%Y-%m-%d %H:%M:%S'}}"
