import copy
import html as html_module
import json
import math
import re
import shutil
import subprocess
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from trialid.report import wording
from trialid.report.page import page, write_page
from trialid.report.series import OutputSeries, read_csv, write_csv
from trialid.report.shape import SHAPE

VOID = {"br", "hr", "img", "input", "link", "meta", "wbr"}
HOSTILE = "</script><script>alert('x')</script><img src=https://evil.example/x onerror=y>"


class Reader(HTMLParser):
    """Text, attributes and the nesting of a page; wrong nesting is an assertion."""

    def __init__(self, html):
        super().__init__(convert_charrefs=True)
        self.open, self.attributes, self.words, self.tags = [], [], [], []
        self.content = {"script": [], "style": []}
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        names = [name for name, _ in attrs]
        assert len(set(names)) == len(names), (tag, names)
        self.attributes += [(tag, *each) for each in attrs]
        self.tags.append(tag)
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert tag not in VOID
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in self.content:
            self.content[self.open[-1]].append(data)
        else:
            self.words.append(data)

    @property
    def text(self):
        return " ".join(self.words)


@pytest.fixture(scope="module")
def html(result, series):
    return page(result, series)


def test_the_page_is_well_formed_and_its_links_lead_somewhere(html):
    read = Reader(html)
    ids = [value for _, name, value in read.attributes if name == "id"]
    assert len(set(ids)) == len(ids)
    links = [value for tag, name, value in read.attributes if (tag, name) == ("a", "href")]
    assert {link.removeprefix("#") for link in links} <= set(ids)
    assert ("html", "lang", "en") in read.attributes
    assert ("meta", "name", "viewport") in read.attributes


def test_the_page_asks_the_network_for_nothing(html):
    read = Reader(html)
    assert not [each for each in read.attributes if each[1] in ("src", "srcset", "action")]
    assert [v for t, n, v in read.attributes if (t, n) == ("link", "href")] == ["data:,"]
    style, script = "".join(read.content["style"]), "".join(read.content["script"])
    assert "url(" not in style
    assert "@import" not in style
    # uPlot's own name in its first comment is all that looks like an address.
    assert set(re.findall(r"https?://[^\s'\"]+", html)) == {"https://github.com/leeoniya/uPlot"}
    assert not re.search(r"\bfetch\(|XMLHttpRequest|WebSocket|import\(", script)
    policy = next(v for _, n, v in read.attributes if n == "content" and "default-src" in v)
    assert policy.startswith("default-src 'none'")


def test_the_licence_of_the_plots_goes_with_them(html):
    assert "Copyright (c) 2022 Leon Sorokin" in html
    assert "Permission is hereby granted" in html


def _numbers(value):
    match value:
        case bool() | None:
            return
        case int() | float():
            yield value
        case dict():
            for key, each in value.items():
                if key not in ("picture", "low", "high"):  # drawn, or read from
                    yield from _numbers(each)
        case list():
            for each in value:
                yield from _numbers(each)


def _renderings(value):
    for digits in range(2, 8):
        yield wording.percent(value, digits)
        yield wording.number(value, digits)
        yield wording.number(value * 180 / math.pi, digits)


def test_every_number_of_the_result_is_on_the_page(html, result):
    tokens = set(re.split(r"[ \n,;()]+", Reader(html).text))
    tokens |= {f"{a}{wording.THIN}%" for a in tokens if re.fullmatch(r"[\d.]+", a)}  # low ends
    absent = [v for v in _numbers(result) if tokens.isdisjoint(_renderings(v))]
    assert absent == []


def test_the_first_screen_says_it_all(html, result):
    text = Reader(html).text
    first = text[: text.index("Before and after")]
    assert wording.prose(result["verdict"]["sentence"]) in first
    for fraction in (0.1264, 0.1437, 0.0841, 0.0944, 0.0871, 0.0912):
        assert wording.percent(fraction) in first
    assert "quiet stretch" in first
    assert "yaw_drag" in first.replace("_ ", "_")


def test_the_bound_is_explained_in_one_sentence(html):
    assert "about as large as the part that is left to see" in Reader(html).text


def test_check_trials_are_labelled_held_out(html):
    assert Reader(html).text.count("held out, not fitted") == 1


@pytest.mark.parametrize("result_of_nothing", [{}, dict.fromkeys(SHAPE)])
def test_nothing_known_still_makes_a_page(result_of_nothing, series):
    read = Reader(page(result_of_nothing, series))
    assert "None" not in read.text
    assert "nan" not in read.text.split()
    assert wording.DASH in read.text
    Reader(page(result_of_nothing, ()))


def _nulled(value, key):
    """The result with one key null wherever it stands."""
    match value:
        case dict():
            return {k: None if k == key else _nulled(v, key) for k, v in value.items()}
        case list():
            return [_nulled(each, key) for each in value]
        case _:
            return value


def _keys(value):
    match value:
        case dict():
            return set(value).union(*map(_keys, value.values()))
        case list():
            return set().union(*map(_keys, value))
        case _:
            return set()


def test_any_key_may_be_null(result, series):
    for key in sorted(_keys(result) - {"trials", "name"}):
        text = Reader(page(_nulled(result, key), series[:1])).text
        assert "None" not in text, key


def test_the_reason_stands_beside_what_is_not_known(result, series):
    run = copy.deepcopy(result)
    run["split"] = {"noise": None, "undermodelling": None, "method": "not separable"}
    run["split"]["why"] = "no quiet stretch and no repeat"
    run["before_after"] = None
    run["fit"]["eps_rmsn_check"] = None
    run["trials"] = run["trials"][:3]
    text = Reader(page(run, series[:3])).text
    assert text.count("no quiet stretch and no repeat") == 2
    assert "no trial was held out" in text
    assert "Before and after" not in text


def test_names_are_text_whatever_they_hold(result, series):
    trial = series[0]
    named = replace(
        trial,
        name=HOSTILE,
        inputs={HOSTILE: trial.t},
        outputs=(OutputSeries(HOSTILE, trial.t, trial.t, trial.t > 10),),
    )
    run = json.loads(json.dumps(result).replace("yaw_damping_cubic", json.dumps(HOSTILE)[1:-1]))
    run["pipeline"] = run["trials"][0]["name"] = run["trials"][0]["remarks"] = HOSTILE
    run["trials"][0]["remarks"] = [HOSTILE]
    run["fit"]["eps_rmsn_by_output"][HOSTILE] = 0.5
    run["accuracy"]["parameters"][0]["name"] = HOSTILE
    run["where"][0] |= {"trial": HOSTILE, "output": HOSTILE, "sentence": HOSTILE}
    html = page(run, [named])
    read = Reader(html)
    assert read.tags.count("script") == 2
    assert "img" not in read.tags
    assert HOSTILE in read.text
    data = json.loads(re.search(r'id="series">(.*?)</script>', html, re.DOTALL)[1])
    assert data[0]["name"] == data[0]["panels"][0]["title"] == HOSTILE


def test_a_finished_folder_gives_the_same_page(tmp_path, html, result, series):
    write_csv(tmp_path / "series.csv", series)
    (tmp_path / "result.json").write_text(json.dumps(result))
    again = json.loads((tmp_path / "result.json").read_text())
    write_page(tmp_path / "report.html", again, read_csv(tmp_path / "series.csv"))
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == html


def test_a_long_ranking_keeps_its_tail_closed(result, series):
    run = copy.deepcopy(result)
    run["missing"] = [row | {"rank": k} for k, row in enumerate(run["missing"] * 4, start=1)]
    read = Reader(page(run, series[:1]))
    assert "29 more candidates" in read.text
    assert "4 that this record cannot see" in read.text
    assert "1 not tried" in read.text
    assert ("details", "open", None) not in read.attributes
    for row in run["missing"]:
        assert row["effect"].replace("_", "_ ") in read.text, row["effect"]


PRESSED = """<script>
const [told, panels] = document.querySelectorAll("#trial-0 .window, #trial-0 .panels");
panels.focus();
const windows = [document.activeElement === panels];
for (const key of ["+", "ArrowRight", "ArrowRight", "ArrowRight", "-", "+", "0", "ArrowLeft"]) {
  panels.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  windows.push(told.textContent);
}
document.documentElement.dataset.windows = JSON.stringify(windows);
</script>"""


@pytest.mark.skipif(shutil.which("chromium") is None, reason="needs chromium")
def test_a_browser_draws_the_plots_and_keys_move_them(tmp_path, html):
    path = tmp_path / "report.html"
    path.write_text(html + PRESSED, encoding="utf-8")
    quiet = "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync"
    still = "--disable-background-networking --disable-component-update --window-size=1280,9000"
    profile = f"--user-data-dir={tmp_path / 'profile'}"
    command = ["chromium", "--headless", *quiet.split(), *still.split(), profile, "--dump-dom"]
    done = subprocess.run([*command, path.as_uri()], capture_output=True, timeout=60, check=True)
    shown = done.stdout.decode()
    assert shown.count("<canvas") == 4 * 6
    windows = html_module.unescape(re.search(r'data-windows="(.*?)"', shown)[1])
    part = json.loads(windows)
    half = part[1]
    assert part[0] is True
    assert half == "30.0 s to 89.9 s"
    assert part[3] == part[4] == "60.0 s to 119.9 s"  # moved to the end, no further
    assert part[5] == ""  # zoomed out: the whole trial
    assert part[6] == half
    assert part[7] == part[8] == ""  # the whole trial cannot be moved


def test_whoever_has_no_mouse_or_no_eyes_finds_everything(html):
    read = Reader(html)
    heads = [a for a in read.attributes if a[:2] == ("th", "scope")]
    assert len(heads) == read.tags.count("th")
    first_link = next(v for t, n, v in read.attributes if (t, n) == ("a", "href"))
    assert first_link == "#verdict"
    groups = [v for t, n, v in read.attributes if n == "aria-label" and "Arrow keys" in (v or "")]
    assert len(groups) == 4
    ids = {v for _, n, v in read.attributes if n == "id"}
    for _, name, value in read.attributes:
        if name in ("aria-labelledby", "aria-describedby"):
            assert set(value.split()) <= ids
    pictures = re.findall(r"<svg [^>]*role=\"img\"[^>]*>", html)
    assert pictures
    assert all("aria-label" in each for each in pictures)
    hidden = re.findall(r'<ul class="legend" aria-hidden="true">.*?</ul>', html, re.DOTALL)
    drawn = len(pictures) + sum(each.count("<svg") for each in hidden)
    assert drawn == read.tags.count("svg")


def test_the_page_goes_from_the_verdict_to_what_to_do_next(html):
    order = re.findall(r'<section id="([\w-]+)"', html)
    assert order == ["verdict", "history", "trials", "error", "where", "missing", "proposed",
                     "parameters", "next", "fit", "origin"]  # fmt: skip


def test_hostile_names_are_text_in_every_section(result, series):
    """Every word of the result that is no key of the page's own is set to markup."""
    named = {"effect", "family", "added", "equation", "sentence", "file", "name", "why", "path"}

    def spoilt(value, key=""):
        match value:
            case dict():
                return {k: spoilt(v, k) for k, v in value.items()}
            case list():
                return [spoilt(each, key) for each in value]
            case str() if key in named:
                return HOSTILE
            case _:
                return value

    run = spoilt(result) | {"not_tried": {HOSTILE: HOSTILE}, "history_remark": HOSTILE}
    run["missing"][0] |= {"cosines": {HOSTILE: 0.95}, "parameters": {HOSTILE: {"expected": 1.0}}}
    run["accuracy"]["weak"][0] |= {"parameters": [HOSTILE] * 2, "moves": {HOSTILE: 1.0, "a": 1.0}}
    read = Reader(page(run, series[:1]))
    assert read.tags.count("script") == 2
    assert "img" not in read.tags
    assert read.text.count(HOSTILE) > 20
