"""Nothing shared but the place: test modules import `s175q` beside this file."""
