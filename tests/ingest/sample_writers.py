"""The writers of the sample logs, which lie outside of the package."""

import importlib
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "sample_data"))
write_logs = importlib.import_module("write_logs")
