"""The commands that do many fits: whole structures compared, the runs of a fleet."""

from trialid.cli.many.batch_command import batch
from trialid.cli.many.structures_command import structures

__all__ = ["batch", "structures"]
