"""Turn a sea trial into a ship model you can trust."""

__version__ = "0.1.0"
