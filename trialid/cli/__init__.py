"""The command `trialid`: one file a command."""

__all__: list[str] = []
