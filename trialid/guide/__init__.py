"""The manual: one short page of Markdown for each topic, in the order a reader meets them."""

import re
from importlib import resources
from typing import Final

from trialid.errors import TrialidError, nearest

__all__ = ["TOPICS", "page"]

TOPICS: Final = {
    "first_trial": "from the shipped logs to a named effect, in two commands",
    "logs": "which logs are read, and what a log does not say itself",
    "pipeline_file": "the file that says what is done: every key",
    "ship_file": "the ship's particulars, masses and coefficients: every key",
    "own_ship": "a ship file from length, beam and draught; how far off it is",
    "actuators": "several rudders, thrusters, pods; signals of your own",
    "effects": "what a model is made of, and how to write an effect of your own",
    "verdicts": "what the five verdicts mean, and how each is reached",
    "structures": "whole models compared by leaving out each trial",
    "batch": "a fleet: many ships and voyages, on many cores; what changed",
    "accuracy": "how far off a parameter may be: what each column means",
    "nomenclature": "letters, units and signs",
    "track": "positions, the current",
    "design": "which test to sail next",
    "replay": "a trial played through the fitted model, with alarms",
    "use": "the fitted ship under orders, and as files for others",
    "workbench": "add, look, undo: in the terminal and in a browser",
    "python": "the same from a notebook or a script",
    "trust": "how far the results can be trusted, in figures",
    "contributing": "adding a log format, an effect, a report table",
}
"""Each topic with the line that lists it."""

COMMENT: Final = re.compile(r"^<!--.*?-->\n", re.MULTILINE)
"""A line for whoever writes the page, not for its reader."""


def page(topic: str) -> str:
    """The page of a topic, as Markdown.

    Raises
    ------
    TrialidError
        There is no such topic; the message has the nearest.
    """
    name = re.sub(r"\W", "_", topic.lower()).removesuffix("_md")
    if name not in TOPICS:
        raise TrialidError(f"there is no page {topic!r} in the guide; {nearest(name, TOPICS)}")
    text = resources.files(__name__).joinpath(f"{name}.md").read_text(encoding="utf-8")
    return COMMENT.sub("", text).rstrip() + "\n"
