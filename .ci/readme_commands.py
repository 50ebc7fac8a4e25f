"""Print the README's two commands, one a line: what runs the main job, and what runs the tests."""

import re
import sys
from pathlib import Path

text = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
blocks = re.findall(r"```sh\n(.*?)```", text, flags=re.DOTALL)
commands = [block.strip().replace("\\\n", " ") for block in blocks]
for wanted in ("trialid run pipelines/hidden_effect.toml", "pytest"):
    sys.stdout.write(next(c for c in commands if wanted in c) + "\n")
