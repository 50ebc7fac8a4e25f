"""What the columns of the parameters mean is on the page."""

import re

import pytest

from trialid.report.pages.page import page
from trialid.result.json_file import result_of


@pytest.fixture(scope="module")
def html(result, series):
    return page(result_of(result), series)


def test_every_column_of_the_parameters_is_explained_below_them(html):
    """Each in a sentence that begins with its heading; Eq. 14 is no bound without its condition."""
    section = html.partition('<section id="parameters"')[2]
    head, _, after = section.partition("</thead>")
    note = after.partition('<p class="note"><b>Value')[2].partition("</p>")[0]
    told = [re.sub(r"<[^>]*>", "", b).rstrip(":") for b in re.findall(r"<b>(.*?)</b>", note)]
    columns = [" ".join(re.sub(r"<[^>]*>", "", c).split()) for c in re.findall("<th.*?</th>", head)]
    ours = {"likely from": "Likely from … to", "likely by noise alone": "Likely, by noise alone"}
    wanted = [ours.get(c, c[0].upper() + c[1:]) for c in columns]
    assert len(columns) == 14
    assert [c for c in wanted if c not in (*told, "Parameter", "Value", "Unit", "To")] == []
    assert "only as far as the part" in note
    assert "as large as the part that is left to see" in note
