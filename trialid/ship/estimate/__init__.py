"""A ship nobody has tested: her file from her particulars, each number with source and scatter."""

from trialid.ship.estimate.all_numbers import Estimated, estimate, ship_from_particulars
from trialid.ship.estimate.particulars_given import Given

__all__ = ["Estimated", "Given", "estimate", "ship_from_particulars"]
