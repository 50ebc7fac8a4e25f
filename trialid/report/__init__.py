"""What a run leaves behind: a page, a terminal summary, a CSV and an MCAP file.

Everything here is made from the mapping of `result.json` and the time series, nothing else, so
that a finished run folder is enough to make it again.
"""

__all__: list[str] = []
