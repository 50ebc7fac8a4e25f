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

from trialid.errors import TrialidError
from trialid.names import wording
from trialid.report.pages.page import page, write_page
from trialid.result import json_file
from trialid.result.json_file import result_of, text_of
from trialid.result.series import OutputSeries, read_csv, write_csv

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
    return page(result_of(result), series)


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


def test_check_trials_are_labelled_held_out(html):
    assert Reader(html).text.count("held out, not fitted") == 1


def nullable():
    """Keys at the top of a result that may be null."""
    keys = json_file.json_schema()["properties"].items()
    return [key for key, each in keys if {"type": "null"} in each.get("anyOf", ())]


@pytest.mark.parametrize("known", [{}, dict.fromkeys(nullable())])
def test_nothing_known_still_makes_a_page(known, series):
    nothing = result_of(known)
    read = Reader(page(nothing, series))
    assert "None" not in read.text
    assert "nan" not in read.text.split()
    assert wording.DASH in read.text
    Reader(page(nothing, ()))


def _nulled(value, key, spared=()):
    """The result with one key null wherever it stands, but in the parts that are spared."""
    match value:
        case dict():
            within = {k: v if k in spared else _nulled(v, key, spared) for k, v in value.items()}
            return within | ({key: None} if key in value else {})
        case list():
            return [_nulled(each, key, spared) for each in value]
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


def known_without(spoilt, key):
    """The result without knowledge of a key; None where the schema wants it: refused by its key."""
    try:
        return result_of(spoilt)
    except TrialidError as error:
        where, _, why = str(error).partition(": ")
        assert key in where.split(".") or f"using '{key}'" in why, (key, where, why)
        assert why.startswith("input should be ") or f"using '{key}'" in why, why
        assert "\n" not in why
        return None


WANTED = {"by", "edges", "fit", "names", "output", "parameters", "routes", "step"}
MAY_BE_UNKNOWN = {
    "before", "before_after", "by_output", "converged", "eps_rmsn", "eps_rmsn_check", "interval",
    "method", "next_trial", "noise", "p_value", "picture", "refitted", "relative_error", "ship",
    "stability", "standard_error", "t_start", "undermodelling", "undermodelling_interval",
    "value", "why",
}  # fmt: skip
"""Some keys of either kind: what a row is about, and what a run may not find out."""


def test_any_key_may_be_null(result, series):
    """Any but what the schema wants: no knowledge is told as None, no wrong key is passed over."""
    refused = set()
    for key in sorted(_keys(result) - {"trials", "name"}):
        # An iteration has its numbers, and a row by output is empty where none is known.
        for spared in ((), ("iterations", "where_else", "trials", "before_after")):
            run = known_without(_nulled(result, key, spared), key)
            if run is not None:
                assert "None" not in Reader(page(run, series[:1])).text, key
        if run is None:
            refused.add(key)
    assert refused & WANTED == WANTED
    assert refused & MAY_BE_UNKNOWN == set()


def test_the_reason_stands_beside_what_is_not_known(result, series):
    run = copy.deepcopy(result)
    run["split"] = {"noise": None, "undermodelling": None, "method": "not separable"}
    run["split"]["why"] = "no quiet stretch and no repeat"
    run["before_after"] = None
    run["fit"]["eps_rmsn_check"] = None
    run["trials"] = run["trials"][:3]
    text = Reader(page(result_of(run), series[:3])).text
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
    run["pipeline"] = run["trials"][0]["name"] = HOSTILE
    run["trials"][0]["remarks"] = [HOSTILE]
    run["fit"]["eps_rmsn_by_output"][HOSTILE] = 0.5
    run["accuracy"]["parameters"][0]["name"] = HOSTILE
    run["where"][0] |= {"trial": HOSTILE, "output": HOSTILE, "sentence": HOSTILE}
    html = page(result_of(run), [named])
    read = Reader(html)
    assert read.tags.count("script") == 2
    assert "img" not in read.tags
    assert HOSTILE in read.text
    data = json.loads(re.search(r'id="series">(.*?)</script>', html, re.DOTALL)[1])
    assert data[0]["name"] == data[0]["panels"][0]["title"] == HOSTILE


def test_a_finished_folder_gives_the_same_page(tmp_path, html, result, series):
    write_csv(tmp_path / "series.csv", series)
    (tmp_path / "result.json").write_text(text_of(result_of(result)))
    again = json_file.read(tmp_path / "result.json")
    write_page(tmp_path / "report.html", again, read_csv(tmp_path / "series.csv"))
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == html


def test_a_long_ranking_keeps_its_tail_closed(result, series):
    run = copy.deepcopy(result)
    run["missing"] = [row | {"rank": k} for k, row in enumerate(run["missing"] * 4, start=1)]
    read = Reader(page(result_of(run), series[:1]))
    assert "33 more candidates" in read.text
    assert "4 that this record cannot see" in read.text
    assert "1 not tried" in read.text
    assert ("details", "open", None) not in read.attributes
    for row in run["missing"]:
        assert row["effect"].replace("_", "_ ") in read.text, row["effect"]


PRESSED = """<script type="module">
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
                     "parameters", "use", "next", "fit", "origin"]  # fmt: skip


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
    read = Reader(page(result_of(run), series[:1]))
    assert read.tags.count("script") == 2
    assert "img" not in read.tags
    assert read.text.count(HOSTILE) > 20
