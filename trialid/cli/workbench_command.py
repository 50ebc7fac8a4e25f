"""The command that opens the workbench in a browser."""

import errno
import secrets
import socket
from pathlib import Path
from typing import Final

import click

from trialid.cli.console import say
from trialid.errors import TrialidError

PORT: Final = 8642
TAKEN: Final = (errno.EADDRINUSE, errno.EACCES)
"""What another port may mend."""

TRIED: Final = 20
"""Ports tried from the usual one on, so that several pipelines can be open at once."""


@click.command(short_help="Do the loop by hand in a browser: look, add, undo.")
@click.argument("pipeline", type=click.Path(path_type=Path))
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    help=f"The port to answer on; by default {PORT} or the next that is free, 0 for any.",
)
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="The address to answer on; whoever asks needs the token in the address that is printed.",
)
@click.option("--open", "opened", is_flag=True, help="Open the page in the browser at once.")
def workbench(pipeline: Path, port: int | None, host: str, opened: bool) -> None:
    """Do the loop of PIPELINE by hand, in a browser: compare, see what is missing, add it.

    Every edit on the screen is one of the file, at once; what is edited elsewhere appears on the
    screen. Ctrl-C ends it, and nothing is lost. The printed address holds a token, without which
    nobody, no other user of this machine either, sees or edits anything.
    """
    from trialid.workbench.desk import Desk

    desk = Desk(pipeline)
    try:
        from trialid.workbench.server import serve
    except ImportError as error:
        raise TrialidError(
            "the workbench needs two packages more: pip install 'trialid[workbench]'"
        ) from error
    token = secrets.token_urlsafe(24)
    with _listening(host, port) as listening:
        address = _address(host, listening.getsockname()[1], token)
        say(f"Workbench: {address}")
        say(f"Every edit is in {pipeline} at once. Ctrl-C ends it.")
        if opened:
            click.launch(address)
        serve(desk, listening, token)


def _listening(host: str, port: int | None) -> socket.socket:
    """A socket that listens on the port asked for, or on the first free one."""
    if not host.strip():  # which would be every address there is
        raise TrialidError(
            "the workbench cannot answer on an empty --host; give an address, or none"
        )
    last: OSError | None = None
    for wanted in range(PORT, PORT + TRIED) if port is None else (port,):
        try:
            return socket.create_server((host, wanted), family=_family(host))
        except OSError as error:
            if error.errno not in TAKEN:
                why = (error.strerror or str(error)).lower().partition(" (while")[0]
                raise TrialidError(
                    f"--host {host}: the workbench cannot answer on it ({why})"
                ) from error
            last = error
    reason = "" if last is None else (last.strerror or str(last)).lower()
    where = f"{host} port {PORT if port is None else port}"
    raise TrialidError(f"the workbench cannot answer on {where} ({reason}); choose another --port")


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET


def _address(host: str, port: int, token: str) -> str:
    place = f"[{host}]" if ":" in host else host
    return f"http://{place}:{port}/?token={token}"
