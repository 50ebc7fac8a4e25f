"""Bags of ROS: messages to channels as those of MCAP, of which the newer bags are files anyway."""

__all__: list[str] = []
