"""The version, where whatever needs it finds it without the rest of the package."""

VERSION = "0.1.0"
