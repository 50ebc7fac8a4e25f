"""Tables as CSV, Markdown and LaTeX: digits by the error, names as text."""

import csv
import io
import math

import pytest

from trialid.report.tables.rounded_table import (
    Figure,
    Table,
    as_csv,
    as_latex,
    as_markdown,
    by_error,
    document,
    latex_text,
)

HOSTILE = "<script>alert('x')</script> | $x_1$ \\input{/etc/passwd} 50% & #{}~^\n\"`*[a](b) 船 é"


def table(*rows):
    return Table("t", "T", ("name", "x"), rows)


@pytest.mark.parametrize(("value", "error", "said"), [
    (0.0123456789, 4e-4, "0.01235"),
    (-8.9704e-05, 7.9e-06, "-8.97e-05"),
    (0.329123, 0.0014, "0.3291"),
    (123456.0, 100.0, "1.2346e+05"),
    (12.0, 5.0, "12.0"),
    (0.0, 1.0, "0"),
    (math.nan, 1.0, ""),
    (None, None, ""),
])  # fmt: skip
def test_digits_follow_the_error(value, error, said):
    (row,) = list(csv.reader(io.StringIO(as_csv(table(("a", by_error(value, error)))))))[1:]
    assert row == ["a", said]
    if said:
        assert math.isclose(float(said), value, rel_tol=1e-2)


def test_the_three_forms_say_the_same_number():
    made = table(("a", Figure(-8.97e-5, 3)))
    assert "−8.97\N{NARROW NO-BREAK SPACE}×" in as_markdown(made)  # noqa: RUF001
    assert r"$-$8.97\,$\times$\,10$^{-}$$^{5}$" in as_latex(made)
    assert "-8.97e-05" in as_csv(made)


def test_a_hostile_name_is_text_in_csv():
    (row,) = list(csv.reader(io.StringIO(as_csv(table((HOSTILE, Figure(1.0)))))))[1:]
    assert row == [HOSTILE, "1.000"]


def test_a_hostile_name_is_text_in_markdown():
    *_, last = as_markdown(table((HOSTILE, Figure(1.0)))).splitlines()
    bare = last.replace("\\\\", "")
    assert not [k for k, c in enumerate(bare) if c in "<>[]`*$_" and bare[k - 1] != "\\"]
    unescaped = [k for k, c in enumerate(bare) if c == "|" and (k == 0 or bare[k - 1] != "\\")]
    assert len(unescaped) == 3


def test_a_hostile_name_is_text_in_latex():
    text = latex_text(HOSTILE)
    assert r"\input" not in text
    assert r"\textbackslash{}input" in text
    assert r"50\% \& \#" in text
    assert "[U+8239]" in text
    assert "\n" not in text


def test_signs_of_the_field_are_mathematics_in_latex():
    assert latex_text("\u2207 \u03c1 \u03b4") == r"$\nabla$ $\rho$ $\delta$"


def test_a_line_of_latex_may_begin_with_a_bracket():
    assert r"{}[a] & 1.000 \\" in as_latex(table(("[a]", Figure(1.0))))


def test_the_document_takes_in_every_table():
    text = document([table(("a", Figure(1.0)))])
    assert r"\input{t.tex}" in text
    assert text.count(r"\begin{document}") == text.count(r"\end{document}") == 1


def test_a_row_that_does_not_fit_its_headings_is_refused():
    with pytest.raises(ValueError, match="t: 1 cells under 2"):
        table(("a",))
