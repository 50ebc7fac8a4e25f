"""The sample written into a folder: pipelines, ships and logs, as they lie in the project."""

from importlib import resources
from pathlib import Path
from typing import Final

from trialid import own_files, temporary
from trialid.errors import TrialidError

SHIPPED: Final = (
    "pipelines/hidden_effect.toml",
    "pipelines/structures.toml",
    "pipelines/design_s175q.toml",
    "pipelines/design_rivals.toml",
    "pipelines/design_programme.toml",
    "pipelines/design_classes_s175q.toml",
    "pipelines/design_classes_naval.toml",
    "sample_data/README.md",
    "sample_data/ships/naval.toml",
    "sample_data/ships/s175.toml",
    "sample_data/ships/s175q.toml",
)
"""Texts that lie in a wheel beside this file and in a clone at its top."""

LOGS: Final = "sample_data/hidden_effect"
"""Folder of the logs, which are no part of a wheel: the simulator makes them."""

LOG_FILES: Final = ("zigzag-10.mcap", "zigzag-20.mcap", "binary-15.mcap", "zigzag-15.csv")


def write(folder: Path) -> tuple[str, ...]:
    """Write the sample into a folder; the names of its files.

    Raises
    ------
    TrialidError
        A file that is not ours has the name of one of these, or the folder cannot be written;
        then nothing has moved.
    """
    names = (*SHIPPED, *(f"{LOGS}/{file}" for file in LOG_FILES))
    if folder.exists() and not folder.is_dir():
        raise TrialidError(f"{folder}: is a file; DIR is a folder")
    temporary.check_writable(folder, "DIR")
    own_files.check(folder, names, option="DIR")
    with (
        own_files.write_or_say_why(folder, option="DIR"),
        own_files.replacing(folder, option="DIR") as work,
    ):
        _fill(work)
    return names


def _fill(work: Path) -> None:
    from trialid.sample.hidden_effect import write_logs

    for name in SHIPPED:
        (work / name).parent.mkdir(parents=True, exist_ok=True)
        (work / name).write_bytes(shipped_text(name))
    (work / LOGS).mkdir()
    write_logs(work / LOGS, work / "sample_data/ships/s175q.toml")


def shipped_text(name: str) -> bytes:
    """One of `SHIPPED`, from the wheel or from the clone that this package lies in."""
    beside = resources.files(__package__).joinpath("shipped", name)
    if beside.is_file():
        return beside.read_bytes()
    return Path(__file__).parents[2].joinpath(name).read_bytes()
