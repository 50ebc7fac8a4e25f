"""The page and its interface, by a real server on a free port."""

import contextlib
import http.client
import json
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import quick
from quick import ADDED, OTHER, Address, Answer, Desk, diagnosed

from trialid.guide import TOPICS
from trialid.pipeline_file import load
from trialid.result.json_file import result_of, text_of

LINE = 600


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Desk]:
    with quick.opened(quick.write(tmp_path_factory.mktemp("server") / "alone")) as made:
        diagnosed(made)
        yield made


@pytest.fixture(scope="module")
def address(desk: Desk) -> Iterator[Address]:
    with quick.serving(desk) as found:
        yield found


@pytest.fixture
def as_written(desk: Desk) -> Iterator[bytes]:
    """Give the file as it was, and as it is again in the end."""
    text = desk.path.read_bytes()
    yield text
    while desk.status.undo:
        desk.undo(desk.status.version)
    diagnosed(desk)
    assert desk.path.read_bytes() == text


def refused(answer: Answer, status: int = 400, kind: str = "refused") -> str:
    """The one line of a refusal."""
    assert answer.status == status, answer.body
    said = answer.json
    assert set(said) == {"error", "kind"}
    assert said["kind"] == kind
    assert "\n" not in said["error"]
    assert 0 < len(said["error"]) < LINE
    return str(said["error"])


# --- what it gives ------------------------------------------------------------------------------


def test_status_screen_series_and_result(desk: Desk, address: Address) -> None:
    status = address.status()
    assert set(status) == {"serial", "version", "stage", "working", "trouble", "undo", "redo",
                           "screen", "series"}  # fmt: skip
    assert (status["stage"], status["working"], status["trouble"]) == ("diagnosed", None, None)
    run = desk.shown.run
    assert run is not None
    result = address.get("/api/result").json
    assert result == json.loads(text_of(run.result))
    assert result_of(result) == run.result
    screen = address.get("/api/screen").json
    assert set(screen) == {"screen", "version", "parts", "facts"}
    assert (screen["screen"], screen["version"]) == (status["screen"], status["version"])
    assert screen["facts"]["eps_rmsn"] == result["fit"]["eps_rmsn"]
    assert screen["facts"]["effects"] == list(load(desk.path).model.effects)
    assert all(isinstance(part, str) for part in screen["parts"].values())
    for i, name in enumerate(("early", "late")):
        series = address.get(f"/api/series/{i}").json
        assert series["series"] == status["series"]
        assert name in json.dumps(series)
    assert address.get("/api/series/2").status == 404


def test_the_page_and_its_downloads(desk: Desk, address: Address) -> None:
    page = address.get("/")
    assert (page.status, page.headers["content-type"]) == (200, "text/html; charset=utf-8")
    assert b"<title>" in page.body
    assert b"style=" not in page.body  # nothing that the page's policy would stop
    assert b"<script>" not in page.body
    told = 'attachment; filename="{}"'
    report = address.get("/report.html")
    assert report.headers["content-disposition"] == told.format("report.html")
    assert b"righting_arm_cubic" in report.body
    copy = address.get("/pipeline.toml")
    assert copy.headers["content-disposition"] == told.format("pipeline.toml")
    assert copy.body == desk.path.read_bytes()


@pytest.mark.parametrize("topic", TOPICS)
def test_the_guide_is_served(address: Address, topic: str) -> None:
    """As HTML that the policy of the page allows; the links of its Markdown lead on."""
    answer = address.get(f"/guide/{topic}")
    assert (answer.status, answer.headers["content-type"]) == (200, "text/html; charset=utf-8")
    assert "default-src 'none'" in answer.headers["content-security-policy"]
    text = answer.body.decode()
    assert text.count("<h1>") == 1
    for forbidden in ("style=", "<script", "<!--"):
        assert forbidden not in text
    for link in re.findall(r'href="(\w+\.md)"', text):
        assert address.get(f"/guide/{link}").status == 200, link


def test_the_guide_is_listed_and_linked(address: Address) -> None:
    assert b'href="/guide"' in address.get("/").body
    listed = address.get("/guide").body.decode()
    assert all(f'href="/guide/{topic}"' in listed for topic in TOPICS)
    wrong = address.get("/guide/verdict")
    assert wrong.status == 404
    assert "'verdicts'" in wrong.json["error"]
    assert address.get("/guide/..%2f..%2fcli").status == 404


def test_before_a_run_is_there(tmp_path: Path) -> None:
    path = quick.write(tmp_path, quick.TEXT.replace('"rot"', '"rate"'))
    with quick.opened(path) as desk, quick.serving(desk) as address:
        quick.settled(desk)
        status = address.status()
        assert status["trouble"]["where"] in ("logs", "fit", "pipeline")
        assert "rate" in status["trouble"]["words"]
        assert status["stage"] == "reading"
        assert address.get("/api/screen").status == 200
        for name in ("/api/result", "/report.html", "/api/series/0"):
            answer = address.get(name)
            assert (answer.status, set(answer.json)) == (404, {"error"})
        refused(address.post("/api/export", {}))
        path.write_text(quick.TEXT, encoding="utf-8")
        quick.until(lambda: desk.status.stage == "diagnosed", "the mended file")
        assert address.status()["trouble"] is None


class Listener:
    """A page that listens for news."""

    def __init__(self, address: Address) -> None:
        self.link = http.client.HTTPConnection("127.0.0.1", address.port, timeout=quick.LONGEST)
        self.link.request("GET", "/api/events")
        self.answer = self.link.getresponse()

    def next(self) -> Any:
        """The next event, as the status it carries."""
        line = self.answer.readline()
        assert line.startswith(b"data: "), line
        assert self.answer.readline() == b"\n"
        return json.loads(line[6:])


def test_news_come_at_once_and_with_every_change(
    desk: Desk, address: Address, as_written: bytes
) -> None:
    listener = Listener(address)
    with contextlib.closing(listener.link):
        kind = listener.answer.headers["content-type"]
        assert kind.startswith("text/event-stream")
        first = listener.next()
        assert first == address.status()
        answer = address.edit("add", effect=ADDED)
        assert answer.status == 200
        seen = [listener.next()]
        while seen[-1]["working"] is not None:
            seen.append(listener.next())
    assert seen[-1]["undo"] == f"add {ADDED}"
    assert seen[-1]["version"] != first["version"]
    serials = [one["serial"] for one in (first, *seen)]
    assert serials == sorted(set(serials))
    assert any(one["working"] and one["working"]["words"] for one in seen)
    assert seen[-1] == address.status()


def test_a_page_that_goes_away_harms_nobody(address: Address) -> None:
    for _ in range(20):
        listener = Listener(address)
        listener.next()
        listener.link.close()
        listener.answer.close()
    assert address.get("/api/status").status == 200


# --- what it does -------------------------------------------------------------------------------


def test_edits_by_the_page(desk: Desk, address: Address, as_written: bytes) -> None:
    old = address.status()["version"]
    answer = address.edit("add", effect=ADDED)
    assert answer.status == 200
    assert answer.json["version"] != old
    assert answer.json["undo"] == f"add {ADDED}"
    assert load(desk.path).model.effects[-1] == ADDED
    late = {"version": old, "do": "add", "effect": OTHER}
    assert "was changed meanwhile" in refused(address.post("/api/edit", late), 409, "changed")
    assert "was changed meanwhile" in refused(
        address.post("/api/undo", {"version": old}), 409, "changed"
    )
    words = refused(address.edit("add", effect=ADDED))
    assert "is there already" in words
    undone = address.post("/api/undo", {"version": answer.json["version"]}).json
    assert (undone["version"], undone["redo"]) == (old, f"add {ADDED}")
    assert desk.path.read_bytes() == as_written
    again = address.post("/api/redo", {"version": old}).json
    assert again["version"] == answer.json["version"]
    assert address.post("/api/cancel", {}).status == 200
    assert address.post("/api/again", {}).status == 200
    diagnosed(desk)


BODIES = (
    b"", b"null", b"[]", b"3", b'"add"', b"{", b"{}}", b"\xff", b"{'do': 1}",
    b"[" * 60000, b'{"a":' * 10000, b"9" * 60000, b"-", b"\x00", b'{"do": "add"', b"NaN", b"{,}",
)  # fmt: skip


@pytest.mark.parametrize("body", BODIES, ids=lambda body: repr(body[:10]))
def test_a_body_that_is_no_object(desk: Desk, address: Address, body: bytes) -> None:
    text = desk.path.read_bytes()
    for act in ("edit", "undo", "redo", "cancel", "again", "export"):
        answer = address.ask("POST", f"/api/{act}", body)
        assert refused(answer, 400, "invalid") == "send one JSON object"
    assert desk.path.read_bytes() == text
    assert desk.status.working is None


def spoilt(chance: random.Random) -> bytes:
    """A body that is nearly an edit: another type, key or byte, a thing too many or too few."""
    words = ["add", "drop", "free", "bounds", "value", "use", "undo", "", "\ud800", "x" * 900, "\n",
             "GM", ADDED, "late", "fit"]  # fmt: skip
    odd: list[Any] = [None, True, 0, -1.5, 1e400, float("nan"), 10**30, [], {}, [[]], {"a": 1}]
    keys = ["version", "do", "effect", "parameter", "free", "low", "high", "value", "trial", "use",
            "name", "\x00", ""]  # fmt: skip
    thing = {
        key: chance.choice(words if chance.random() < 0.6 else odd)
        for key in chance.sample(keys, chance.randrange(len(keys)))
    }
    if chance.random() < 0.5:
        thing["do"] = chance.choice(words[:6])
    body = bytearray(json.dumps(thing).encode())
    if chance.random() < 0.3:
        for _ in range(chance.randrange(1, 4)):
            body[chance.randrange(len(body))] = chance.randrange(256)
    return bytes(body)


def test_no_spoilt_body_changes_anything(desk: Desk, address: Address) -> None:
    text, status = desk.path.read_bytes(), desk.status
    names = sorted(p.name for p in desk.path.parent.iterdir())
    chance = random.Random(4)
    for i in range(400):
        act = ("edit", "edit", "edit", "undo", "redo")[i % 5]
        body = spoilt(chance)
        answer = address.ask("POST", f"/api/{act}", body)
        assert 400 <= answer.status < 500, (body, answer.body)
        said = answer.json
        assert said["kind"] in ("refused", "invalid", "changed"), body
        assert "\n" not in said["error"], body
        assert 0 < len(said["error"]) < LINE, body
    assert desk.path.read_bytes() == text
    assert desk.status == status
    assert sorted(p.name for p in desk.path.parent.iterdir()) == names


def test_no_spoilt_edit_of_this_very_file_breaks_it(
    desk: Desk, address: Address, as_written: bytes
) -> None:
    """With the right version some are edits: the file is a pipeline after each."""
    chance = random.Random(5)
    done = 0
    for _ in range(150):
        body = spoilt(chance)
        with contextlib.suppress(ValueError):
            thing = json.loads(body)
            body = json.dumps({**thing, "version": desk.status.version}).encode()
        answer = address.ask("POST", "/api/edit", body)
        assert answer.status in (200, 400), (body, answer.body)
        done += answer.status == 200
        load(desk.path)
    assert desk.path.read_bytes() == as_written or done


# --- what leaves it -----------------------------------------------------------------------------


NAMES = (
    "", ".", "..", ".toml", "a", "a.tom", "a.toml.bak", "a.TOML ", "../a.toml", "a/b.toml",
    "/tmp/a.toml", "\\a.toml", "..\\a.toml", "C:a.toml", "C:\\a.toml", "a\\b.toml", "a\x00.toml",
    "\x00.toml", "a\n.toml", "a\x1b[31m.toml", "\ud800.toml", ".hidden.toml", "a" * 250 + ".toml",
    "é" * 120 + ".toml", "quick.toml", "con.toml", "NUL.toml", "aux.x.toml", "COM1.toml",
    "lpt9.toml", "a:b.toml", "a*.toml", "a?.toml", 'a".toml', "a<b.toml", "a|b.toml", "./a.toml",
    "a.toml/", "%2e%2e%2fa.toml/", "\u202ea.toml",
)  # fmt: skip


@pytest.mark.parametrize("name", NAMES, ids=lambda name: ascii(name[:20]))
def test_a_copy_under_a_name_that_is_none(desk: Desk, address: Address, name: str) -> None:
    folder = desk.path.parent
    before = {p: p.stat().st_mtime_ns for p in folder.parent.rglob("*")}
    refused(address.post("/api/export", {"name": name}))
    assert {p: p.stat().st_mtime_ns for p in folder.parent.rglob("*")} == before


@pytest.mark.parametrize("name", [3, True, [], {}, 1.5])
def test_a_copy_under_what_is_no_name(address: Address, name: Any) -> None:
    assert refused(address.post("/api/export", {"name": name})) == "name: expected text"


def test_a_copy_of_the_pipeline(desk: Desk, address: Address) -> None:
    for name in ("a copy.toml", "zweite Fassung é.toml", "quick-2.toml", "content.toml"):
        answer = address.post("/api/export", {"name": name})
        assert answer.status == 200
        assert answer.json["files"] == [name]
        made = desk.path.with_name(name)
        assert made.read_bytes() == desk.path.read_bytes()
        assert load(made).trials == load(desk.path).trials
        assert "is there already" in refused(address.post("/api/export", {"name": name}))
        made.unlink()


def test_the_folder_of_a_run(
    desk: Desk, address: Address, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    answer = address.post("/api/export", {})
    assert answer.status == 200
    files = answer.json["files"]
    assert files == sorted(p.as_posix() for p in Path("runs/quick").iterdir())
    assert {"runs/quick/result.json", "runs/quick/report.html"} <= set(files)
    written = json.loads(Path("runs/quick/result.json").read_text(encoding="utf-8"))
    assert written == address.get("/api/result").json
    assert Path("runs/quick/pipeline.toml").read_bytes() == desk.path.read_bytes()
    assert address.post("/api/export", {}).status == 200  # over the last one


def test_a_folder_that_cannot_be_written(
    address: Address, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("runs").write_text("a file", encoding="utf-8")
    assert "cannot be written" in refused(address.post("/api/export", {}))
