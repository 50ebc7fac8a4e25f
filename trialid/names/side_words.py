"""Words and letters of a side in names and units, and the shaft that stands there."""

from typing import Final

SIDES: Final = {
    "port": "n_p",
    "left": "n_p",
    "bb": "n_p",
    "starboard": "n_s",
    "stbd": "n_s",
    "stb": "n_s",
    "right": "n_s",
    "links": "n_p",
    "rechts": "n_s",
    "backbord": "n_p",
    "steuerbord": "n_s",
    "ps": "n_p",
    "sb": "n_s",
    "bakboord": "n_p",
    "stuurboord": "n_s",
    "babord": "n_p",
    "tribord": "n_s",
    "styrbord": "n_s",
}
LETTERS: Final = {"p": "n_p", "s": "n_s"}
