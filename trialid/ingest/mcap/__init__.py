"""MCAP logs: ROS 2, protobuf and JSON messages."""

__all__: list[str] = []
