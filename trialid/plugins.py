"""What installed packages add: log formats, effects, export formats, by entry points.

A package names them in its `pyproject.toml`:

    [project.entry-points."trialid.adapters"]
    my_format = "my_package.my_log:ADAPTER"
    [project.entry-points."trialid.effects"]
    my_effects = "my_package.my_effects"
    [project.entry-points."trialid.exporters"]
    ".dat" = "my_package.dat_file:write_dat"
"""

from importlib.metadata import entry_points
from typing import Any, Literal

from trialid.errors import PluginError

Group = Literal["trialid.adapters", "trialid.effects", "trialid.exporters"]


def plugins(group: Group) -> dict[str, Any]:
    """What installed packages give under a group, by the entry point's name, in its order.

    Raises
    ------
    PluginError
        One of them cannot be imported; the message names the package.
    """
    found = {}
    for point in sorted(entry_points(group=group), key=lambda each: each.name):
        try:
            found[point.name] = point.load()
        except (
            ImportError,
            AttributeError,
            SyntaxError,
            TypeError,
            ValueError,
            SystemExit,  # else the program would end with nothing said
        ) as error:
            package = point.dist.name if point.dist else point.value
            raise PluginError(
                f"{package}: {group} {point.name!r} ({point.value}) cannot be loaded "
                f"({type(error).__name__}: {error}); mend or uninstall that package"
            ) from error
    return found


def packages() -> dict[str, str]:
    """Packages that add something, with their versions: a result may rest on them."""
    groups: tuple[Group, ...] = ("trialid.adapters", "trialid.effects", "trialid.exporters")
    points = [point for group in groups for point in entry_points(group=group)]
    return {point.dist.name: point.dist.version for point in points if point.dist}
