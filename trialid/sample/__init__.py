"""The sample: four trials of a ship made by the simulator, and the pipelines to try on them."""

from trialid.sample.demo_folder import SHIPPED, write

__all__ = ["SHIPPED", "write"]
