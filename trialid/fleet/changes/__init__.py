"""Changes of ships in the course of their voyages: the records, what is told, and what beside."""

from trialid.fleet.changes.beside_changes import remarks
from trialid.fleet.changes.changes_of_ships import changes
from trialid.fleet.changes.told_from import told_from

__all__ = ["changes", "remarks", "told_from"]
