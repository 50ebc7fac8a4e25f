"""Every mistake of the user's is one line on stderr and an exit status."""

from pathlib import Path
from typing import Any, Final, NoReturn

import click
from click.exceptions import NoArgsIsHelpError

from trialid.cli.console import complain
from trialid.errors import TrialidError, nearest

WRONG_INPUT: Final = 2
STOPPED: Final = 130
"""128 + SIGINT, as shells report a command stopped by the keyboard."""


class OneLineErrors(click.Group):
    """A group whose commands answer the user's mistakes with one line and an exit status."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Options before a command."""
        try:
            return super().parse_args(ctx, args)
        except NoArgsIsHelpError:
            raise
        except click.UsageError as error:
            _refuse(ctx, error)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that was named; TrialidError with the nearest where there is none."""
        name = args[0]
        if name.startswith("-") or self.get_command(ctx, name) is not None:
            return super().resolve_command(ctx, args)
        hint = _for_a_file(name) or nearest(name, self.commands)
        raise TrialidError(f"there is no command {name!r}; {hint}")

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; status 2 for wrong input, 130 when stopped by the keyboard."""
        try:
            return super().invoke(ctx)
        except click.UsageError as error:
            _refuse(ctx, error)
        except TrialidError as error:
            complain(str(error))
            ctx.exit(WRONG_INPUT)
        except OSError as error:
            if error.filename is None:  # no file of the user's: ours to mend
                raise
            complain(str(TrialidError(f"{error.filename}: {(error.strerror or '').lower()}")))
            ctx.exit(WRONG_INPUT)
        except KeyboardInterrupt:
            complain("stopped; no half-written results are left")
            ctx.exit(STOPPED)


def _for_a_file(name: str) -> str:
    """What to do with a file that stands where a command should, empty for what is none."""
    if not Path(name).is_file():
        return ""
    verb = "run" if name.endswith(".toml") else "inspect"
    return f"for that file: trialid {verb} {name}"


def _refuse(ctx: click.Context, error: click.UsageError) -> NoReturn:
    """Say what is wrong with the words of a command, and where its help is."""
    asked = error.ctx.command_path if error.ctx else "trialid"
    said = str(TrialidError(error.format_message())).rstrip(".")
    if isinstance(error, click.NoSuchOption) and error.option_name[1:2].isdigit():
        said = f"{error.option_name}...: a number below zero reads as an option; none is asked for"
    complain(f"{said[:1].lower()}{said[1:]}; see {asked} --help")
    ctx.exit(WRONG_INPUT)
