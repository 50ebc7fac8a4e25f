"""The loop by hand, in a browser: compare, see where it fails, learn what is missing, add it.

The pipeline file is the one truth: every edit on the screen is an edit of it, by the same code as
the command line's, and an edit made elsewhere appears on the screen.
"""

__all__: list[str] = []
