"""What a replay plays: a log, a log that grows, or the frames of a CAN bus."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

import click

from trialid.errors import TrialidError

if TYPE_CHECKING:
    from trialid.pipeline_file import TrialSection
    from trialid.replay.live_bus import LiveBus

LOG: Final = "log"
"""What --follow means where it names no bus."""


class Following(click.Command):
    """A command whose --follow names a bus or nothing; what comes next may be the pipeline."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Arguments as the user gave them."""
        bus = "can:"
        told = [
            f"--follow={LOG}" if arg == "--follow" and not after.startswith(bus) else arg
            for arg, after in zip(args, [*args[1:], ""], strict=True)
        ]
        return super().parse_args(ctx, told)


@contextmanager
def source_of(
    chosen: "TrialSection", follow: str | None, record: Path | None, force: bool
) -> "Iterator[tuple[TrialSection, LiveBus | None]]":
    """The trial to play, with its logs, or with the frames of a bus as its only log."""
    if follow is None or follow == LOG:
        if record is not None:
            raise click.UsageError("--record goes with --follow can:INTERFACE:CHANNEL")
        yield chosen, None
        return
    from trialid.replay.live_bus import NMEA_2000_RATE, LiveBus, address

    at = address(follow)
    if record is not None and record.exists() and not force:
        raise TrialidError(f"--record {record}: exists; name another, or add --force")
    dbc = next((log.dbc for log in chosen.logs if log.dbc is not None), None)
    with TemporaryDirectory(prefix="trialid-bus-") as folder:
        log = record or Path(folder, "frames.log")
        with LiveBus(at, log, NMEA_2000_RATE if dbc is None else None) as bus:
            only = chosen.logs[0].model_copy(
                update={"path": log, "dbc": dbc, "template": None, "zone": None, "clock": None}
            )
            update = {"logs": (only,), "use": "check", "window": None}
            yield chosen.model_copy(update=update), bus
