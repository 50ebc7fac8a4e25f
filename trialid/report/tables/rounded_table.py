"""A table of a report, and its text as CSV, Markdown and LaTeX."""

import csv
import io
import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.names import wording


@dataclass(frozen=True)
class Figure:
    """A number and the significant digits it is worth; None is not known."""

    value: float | None
    digits: int = 4

    @property
    def known(self) -> bool:
        """Whether there is anything to print."""
        return self.value is not None and math.isfinite(self.value)


Cell = str | Figure


@dataclass(frozen=True)
class Table:
    """Headings and rows of one table; `name` is the stem of its files."""

    name: str
    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.headings):
                raise ValueError(f"{self.name}: {len(row)} cells under {len(self.headings)}")


def by_error(value: float | None, error: float | None) -> Figure:
    """A value with the digits its standard error leaves it."""
    return Figure(value, wording.digits_by_error(value, error))


def percent(fraction: float | None) -> Figure:
    """A fraction for a column in percent."""
    return Figure(None if fraction is None else 100.0 * fraction, 3)


def as_csv(table: Table) -> str:
    """Plain numbers with a decimal point; what is not known is empty.

    >>> print(as_csv(Table("t", "T", ("name", "x"), (("Yv", Figure(-0.5, 3)),))), end="")
    name,x
    Yv,-0.500
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(table.headings)
    writer.writerows([_machine(cell) for cell in row] for row in table.rows)
    return stream.getvalue()


def _machine(cell: Cell) -> str:
    if isinstance(cell, str):
        return cell
    if cell.value is None or not cell.known:
        return ""
    if cell.value == 0.0 or isinstance(cell.value, int):
        return str(int(cell.value))
    return f"{cell.value:#.{cell.digits}g}".removesuffix(".").replace(".e", "e")


def as_markdown(table: Table) -> str:
    r"""A table in pipes; names are text, whatever they hold.

    >>> print(as_markdown(Table("t", "T", ("name", "x"), (("<b>", Figure(0.5, 3)),))), end="")
    **T**
    <BLANKLINE>
    | name | x |
    | :--- | ---: |
    | \<b\> | 0.500 |
    """
    align = ["---:" if right else ":---" for right in numeric(table)]
    lines = [f"**{_marked(table.title)}**", "", _piped(map(_marked, table.headings)), _piped(align)]
    lines += [_piped(_shown(cell, _marked) for cell in row) for row in table.rows]
    return "\n".join(lines) + "\n"


def _piped(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _marked(text: str) -> str:
    """Text that Markdown leaves as it is, on one line."""
    return re.sub(r"([\\`*_{}\[\]<>#|&~$!])", r"\\\1", _one_line(text))


def as_latex(table: Table) -> str:
    r"""A plain `tabular`, to be taken in with `\input`; needs no package.

    >>> print(as_latex(Table("t", "T", ("name", "x"), (("Y_v", Figure(-0.5, 3)),))), end="")
    % T
    \begin{tabular}{lr}
    \hline
    name & x \\
    \hline
    Y\_v & $-$0.500 \\
    \hline
    \end{tabular}
    """
    columns = "".join("r" if right else _column(table, i) for i, right in
                      enumerate(numeric(table)))  # fmt: skip
    lines = [f"% {_one_line(table.title)}", f"\\begin{{tabular}}{{{columns}}}", "\\hline"]
    lines += [_ampersands(map(latex_text, table.headings)), "\\hline"]
    lines += [_ampersands(_shown(cell, latex_text) for cell in row) for row in table.rows]
    return "\n".join([*lines, "\\hline", "\\end{tabular}"]) + "\n"


LONG: Final = 40
"""Letters from which on a column of text is set in lines."""


def _column(table: Table, place: int) -> str:
    words = [cell for row in table.rows if isinstance(cell := row[place], str) and " " in cell]
    return "l" if max(map(len, words), default=0) < LONG else "p{7cm}"


def _ampersands(cells: Iterable[str]) -> str:
    # The braces keep a bracket or a star that begins a line from being read as an argument of \\.
    words = list(cells)
    if words and words[0][:1] in ("[", "*"):
        words[0] = "{}" + words[0]
    return f"{' & '.join(words)} \\\\"


def document(tables: Sequence[Table]) -> str:
    r"""A document that takes in every table: `pdflatex tables.tex`."""
    lines = [
        "\\documentclass[a4paper,10pt]{article}",
        "\\usepackage[utf8]{inputenc}",
        "\\pdfpagewidth=420mm \\pdfpageheight=297mm",
        "\\setlength{\\textwidth}{370mm} \\setlength{\\textheight}{250mm}",
        "\\setlength{\\oddsidemargin}{0mm} \\setlength{\\topmargin}{-15mm}",
        "\\setlength{\\parindent}{0pt} \\setlength{\\tabcolsep}{4pt}",
        "\\begin{document}",
        "\\footnotesize",
    ]
    for table in tables:
        lines += [f"\\subsection*{{{latex_text(table.title)}}}", f"\\input{{{table.name}.tex}}", ""]
    return "\n".join([*lines, "\\end{document}"]) + "\n"


def numeric(table: Table) -> list[bool]:
    """Which columns hold numbers only."""
    columns = zip(*table.rows, strict=True) if table.rows else [()] * len(table.headings)
    return [bool(c) and all(isinstance(cell, Figure) for cell in c) for c in columns]


def _shown(cell: Cell, escape: "Escape") -> str:
    if isinstance(cell, str):
        return escape(cell)
    return escape(wording.number(cell.value, cell.digits))


Escape = Callable[[str], str]

_GREEK: Final = "αβγδεζηθικλμνξπρστυφχψω"
_GREEK_NAMES: Final = (
    "alpha beta gamma delta varepsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau "
    "upsilon phi chi psi omega"
)
_SPECIAL: Final = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#",
    "%": r"\%", "_": r"\_", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "<": r"$<$", ">": r"$>$", "|": r"$|$", '"': "{''}", "'": r"{'}", "`": r"{`}",
    "-": r"{-}", wording.DASH: "--", wording.MINUS: "$-$", wording.THIN: r"\,",
    "\N{NO-BREAK SPACE}": "~", "\N{MULTIPLICATION SIGN}": r"$\times$", "\N{PLUS-MINUS SIGN}":
    r"$\pm$", "\N{PRIME}": "$'$", "\N{RIGHTWARDS ARROW}": r"$\rightarrow$", "\N{DEGREE SIGN}":
    r"$^{\circ}$", "\N{MIDDLE DOT}": r"$\cdot$", "\N{LESS-THAN OR EQUAL TO}": r"$\le$",
    "\N{SQUARE ROOT}": r"$\surd$", "\N{NABLA}": r"$\nabla$",
    **{letter: rf"$\{name}$" for letter, name in zip(_GREEK, _GREEK_NAMES.split(), strict=True)},
    **{raised: f"$^{{{plain}}}$" for plain, raised in wording.RAISED.items()},
}  # fmt: skip


def latex_text(text: str) -> str:
    r"""Text as LaTeX prints it; a sign that no plain LaTeX font has is told by its number.

    >>> print(latex_text("50% of $x_1$"), latex_text("船"))
    50\% of \$x\_1\$ [U+8239]
    """
    return "".join(_latex_letter(letter) for letter in _one_line(text))


def _latex_letter(letter: str) -> str:
    if letter in _SPECIAL:
        return _SPECIAL[letter]
    if letter.isascii():
        return letter
    if 0xC0 <= ord(letter) <= 0xFF and letter not in "ÐðÞþ÷":  # the default fonts lack these
        return letter
    return f"[U+{ord(letter):04X}]"


def _one_line(text: str) -> str:
    """Without line ends and other control characters."""
    return "".join(" " if unicodedata.category(c) in ("Cc", "Zl", "Zp") else c for c in text)
