"""Turn a sea trial into a ship model you can trust.

Everything here is imported when it is first asked for, so that `import trialid` is quick.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from trialid.version import VERSION

if TYPE_CHECKING:
    from trialid.alignment import SignalSource, align
    from trialid.effects import CATALOGUE
    from trialid.fleet.fleet_view import batch
    from trialid.fleet.structures_view import structures
    from trialid.identification.fit import Fit
    from trialid.ingest import read
    from trialid.result.schema import Result
    from trialid.ship.effect import Force, Parameter, effect
    from trialid.ship.estimate import ship_from_particulars
    from trialid.ship.model import ShipModel
    from trialid.ship.particulars import read_ship
    from trialid.trial import Trial
    from trialid.workflow.notebook.front import diagnose, identify, run, simulate

__version__ = VERSION

__all__ = [
    "CATALOGUE",
    "Fit",
    "Force",
    "Parameter",
    "Result",
    "ShipModel",
    "SignalSource",
    "Trial",
    "__version__",
    "align",
    "batch",
    "diagnose",
    "effect",
    "identify",
    "read",
    "read_ship",
    "run",
    "ship_from_particulars",
    "simulate",
    "structures",
]

_HOMES: Final = {
    "read": "ingest",
    "align": "alignment",
    "SignalSource": "alignment",
    "Trial": "trial",
    "read_ship": "ship.particulars",
    "ship_from_particulars": "ship.estimate",
    "ShipModel": "ship.model",
    "effect": "ship.effect",
    "Force": "ship.effect",
    "Parameter": "ship.effect",
    "CATALOGUE": "effects",
    "identify": "workflow.notebook.front",
    "diagnose": "workflow.notebook.front",
    "run": "workflow.notebook.front",
    "simulate": "workflow.notebook.front",
    "structures": "fleet.structures_view",
    "batch": "fleet.fleet_view",
    "Fit": "identification.fit",
    "Result": "result.schema",
}
"""Where each name lives, in the order of the work."""


def __getattr__(name: str) -> Any:
    """A public name, imported when it is first asked for."""
    if name not in _HOMES:
        raise AttributeError(f"module 'trialid' has no attribute {name!r}")
    found = getattr(import_module(f"trialid.{_HOMES[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """The public names, whether they were asked for already or not."""
    return sorted({*globals(), *__all__})
