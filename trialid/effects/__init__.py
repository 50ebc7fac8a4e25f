"""The catalogue: every effect the package knows, by name."""

from pathlib import Path
from traceback import extract_tb
from types import ModuleType

from trialid import user_files
from trialid.effects import (
    environment,
    heel,
    hull,
    loading,
    outer,
    propulsion,
    roll,
    rudder,
    sensor_timing,
    sensors,
    steering_gear,
)  # fmt: skip
from trialid.errors import EffectError, PluginError, nearest
from trialid.plugins import plugins
from trialid.ship.effect import Effect

__all__ = ["CATALOGUE", "FILES", "find", "from_file"]

FILES: tuple[ModuleType, ...] = (
    hull, heel, roll, rudder, steering_gear, propulsion, environment, outer, loading, sensors,
    sensor_timing,
)  # fmt: skip
"""In the order a person reads a ship: the hull first, the sensors last."""


class Catalogue(dict[str, Effect]):
    """Effects by name; what is asked for and not there is told with the nearest names."""

    def __missing__(self, name: str) -> Effect:
        raise EffectError(f"there is no effect {name!r}; {nearest(name, self)}")


def _catalogue() -> Catalogue:
    """Ours, then those of installed packages.

    Raises
    ------
    PluginError
        A package declares no effect, or one whose name is taken.
    """
    known = {e.name: e for file in FILES for e in file.EFFECTS}
    for name, module in plugins("trialid.effects").items():
        own = [x for x in vars(module).values() if isinstance(x, Effect)]
        taken = [e.name for e in own if e.name in known]
        if taken or not own:
            why = f"its effect {taken[0]!r} is there already" if taken else "declares no effect"
            raise PluginError(f"trialid.effects {name!r}: {why}; rename it, or uninstall it")
        known |= {e.name: e for e in own}
    return Catalogue(known)


CATALOGUE: Catalogue = _catalogue()

FAULTS = (
    SyntaxError, NameError, ImportError, TypeError, AttributeError, ValueError, ArithmeticError,
    LookupError, AssertionError, OSError, RuntimeError, MemoryError, SystemExit,
)  # fmt: skip
"""What somebody's own Python file may raise while it runs."""


def find(name: str, own: dict[str, Effect]) -> Effect:
    """The effect of this name, the user's own first.

    Raises
    ------
    EffectError
        There is none; the message has the nearest names.
    """
    return Catalogue(CATALOGUE | own)[name]


def from_file(path: Path) -> dict[str, Effect]:
    """The effects a user's own `.py` file declares.

    Raises
    ------
    EffectError
        The file cannot be read or run, or declares no effect.
    """
    try:
        source = user_files.text(path)
    except OSError as error:
        raise EffectError(f"effects file {path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise EffectError(f"effects file {path}: not UTF-8 text (byte {error.start})") from error
    module = ModuleType(path.stem)
    module.__file__ = str(path)
    try:
        exec(compile(source, str(path), "exec"), module.__dict__)
    except EffectError as error:
        raise EffectError(f"effects file {path}{_line(path, error)}: {error}") from error
    except FAULTS as error:
        kind = type(error).__name__
        raise EffectError(f"effects file {path}{_line(path, error)}: {kind}: {error}") from error
    found = {x.name: x for x in vars(module).values() if isinstance(x, Effect)}
    own = {n: e for n, e in found.items() if e.function.__module__ == module.__name__}
    if not own:
        raise EffectError(f"effects file {path}: declares no effect; write one with @effect")
    return own


def _line(path: Path, error: BaseException) -> str:
    """The last line of the file that ran, in words; a syntax error says its own."""
    lines = [f.lineno for f in extract_tb(error.__traceback__) if f.filename == str(path)]
    return f", line {lines[-1]}" if lines else ""
