"""Who is answered: this machine's own pages and whoever holds the token, and nobody else."""

from collections.abc import Iterator

import pytest
import quick
from quick import Address, Answer

from trialid.workbench.guard import HEADERS, LARGEST
from trialid.workbench.server import ASSETS

TOKEN = "a-token-of-which-nobody-knows"
READ = ("/", "/api/status", "/api/screen", "/api/result", "/pipeline.toml", "/workbench.css",
        "/guide", "/guide/logs", "/api/events")  # fmt: skip
ACTS = ("edit", "undo", "redo", "cancel", "again", "export")


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[quick.Desk]:
    with quick.opened(quick.write(tmp_path_factory.mktemp("guard"))) as made:
        quick.diagnosed(made)
        yield made


@pytest.fixture(scope="module")
def own(desk: quick.Desk) -> Iterator[Address]:
    """Give the workbench on this machine's own address."""
    with quick.serving(desk) as address:
        yield address


@pytest.fixture(scope="module")
def open_(desk: quick.Desk) -> Iterator[Address]:
    """Give the workbench on any address, with a token."""
    with quick.serving(desk, TOKEN) as address:
        yield address


def guarded(answer: Answer) -> Answer:
    """An answer, which has every header that keeps other pages out."""
    for name, value in HEADERS.items():
        assert answer.headers.get_all(name) == [value], name
    assert "access-control-allow-origin" not in answer.headers
    return answer


def refused(answer: Answer, status: int) -> Answer:
    """A refusal: one line of plain text that holds nothing of the pipeline."""
    assert guarded(answer).status == status
    assert answer.headers["content-type"] == "text/plain; charset=utf-8"
    assert answer.body.count(b"\n") == 1
    assert b"quick" not in answer.body
    return answer


def everywhere(address: Address, **headers: str) -> list[Answer]:
    """Every way in, with these headers."""
    read = [address.ask("GET", path, headers=headers) for path in READ]
    return read + [address.ask("POST", f"/api/{act}", {}, headers) for act in ACTS]


# --- on this machine ----------------------------------------------------------------------------


@pytest.mark.parametrize("host", [
    "evil.example", "evil.example:{port}", "127.0.0.1.evil.example:{port}",
    "localhost.evil.example", "127.0.0.1@evil.example", "192.168.0.1:{port}",
    "0.0.0.0:{port}", "[::2]:{port}", "[", "", "evil.example#127.0.0.1", "evil.example/127.0.0.1",
])  # fmt: skip
def test_a_name_made_to_point_here_is_not_answered(own: Address, host: str) -> None:
    for answer in everywhere(own, Host=host.format(port=own.port)):
        refused(answer, 403)


@pytest.mark.parametrize("host", [
    "127.0.0.1:{port}", "localhost:{port}", "LOCALHOST", "[::1]:1", "127.0.0.2:{port}",
])  # fmt: skip
def test_its_own_names_are_answered(own: Address, host: str) -> None:
    answer = own.get("/api/status", Host=host.format(port=own.port))
    assert guarded(answer).status == 200


@pytest.mark.parametrize("origin", [
    "http://evil.example", "https://127.0.0.1.evil.example", "null", "", "http://127.0.0.1:1",
    "http://localhost:{port}", "file://", "http://[", "http://[::1", "http://]",
])  # fmt: skip
def test_another_sites_page_is_not_answered(own: Address, origin: str) -> None:
    for answer in everywhere(own, Origin=origin.format(port=own.port)):
        refused(answer, 403)


@pytest.mark.parametrize("site", ["cross-site", "same-site", "Same-Origin", ""])
def test_what_the_browser_says_of_another_site(own: Address, site: str) -> None:
    for answer in everywhere(own, **{"Sec-Fetch-Site": site}):
        refused(answer, 403)


def test_its_own_page_is_answered(own: Address) -> None:
    headers = {"Origin": f"http://127.0.0.1:{own.port}", "Sec-Fetch-Site": "same-origin"}
    assert guarded(own.ask("POST", "/api/cancel", {}, headers)).status == 200
    assert guarded(own.get("/", **{"Sec-Fetch-Site": "none"})).status == 200


@pytest.mark.parametrize("kind", [
    "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", "",
    "text/plain; application/json", "application/jsonx", "application/json, text/plain",
])  # fmt: skip
def test_what_a_form_can_send_is_refused(own: Address, kind: str) -> None:
    for act in ACTS:
        refused(own.ask("POST", f"/api/{act}", b"{}", {"Content-Type": kind}), 415)


def test_json_with_its_letters_named_is_read(own: Address) -> None:
    kind = {"Content-Type": "application/json; charset=utf-8"}
    assert own.ask("POST", "/api/cancel", b"{}", kind).status == 200


def test_what_is_too_long_is_refused(own: Address) -> None:
    body = b" " * (LARGEST - 2) + b"{}"
    assert guarded(own.ask("POST", "/api/cancel", body)).status == 200
    head = f"POST /api/cancel HTTP/1.1\r\nHost: 127.0.0.1:{own.port}\r\n"
    head += "Content-Type: application/json\r\nConnection: close\r\n"
    chunked = "Transfer-Encoding: chunked\r\n"
    for length in (f"Content-Length: {LARGEST + 1}\r\n", f"Content-Length: {10**19}\r\n",
                   chunked, f"Content-Length: 2\r\n{chunked}",
                   f"{chunked}Content-Length: 2\r\n"):  # fmt: skip
        answer = own.raw(f"{head}{length}\r\n".encode())
        assert answer.startswith(b"HTTP/1.1 413 "), (length, answer)


@pytest.mark.parametrize("length", ["-1", "0x10", "1e3", "\xb2", "2, 3", "", "+2"])
def test_a_length_that_is_none_is_refused(own: Address, length: str) -> None:
    head = f"POST /api/cancel HTTP/1.1\r\nHost: 127.0.0.1:{own.port}\r\n"
    head += f"Content-Type: application/json\r\nContent-Length: {length}\r\n\r\n"
    answer = own.raw(head.encode("latin-1") + b"{}")
    assert answer.startswith((b"HTTP/1.1 400 ", b"HTTP/1.1 413 ")), answer


# --- on any address -----------------------------------------------------------------------------


def test_without_the_token_nothing_is_answered(open_: Address) -> None:
    for answer in everywhere(open_):
        refused(answer, 401)


@pytest.mark.parametrize("token", ["", "x", TOKEN[:-1], TOKEN + "x", TOKEN.upper(), "%00", "%ff",
                                   "é"])  # fmt: skip
def test_with_a_wrong_token_nothing_is_answered(open_: Address, token: str) -> None:
    written = token.encode().decode("latin-1") if token == "é" else token
    head = f"GET /?token={written} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"
    answer = open_.raw(head.encode("latin-1"))
    assert answer.startswith((b"HTTP/1.1 401 ", b"HTTP/1.1 400 ")), answer
    name = f"trialid-{open_.port}"
    for cookie in (f"{name}={token}", f"other={TOKEN}", name, ";;;=", f"{name} {TOKEN}",
                   f"trialid={TOKEN}", f"trialid-{open_.port + 1}={TOKEN}"):  # fmt: skip
        sent = open_.get("/api/status", Cookie=cookie.encode().decode("latin-1"))
        refused(sent, 401)
    for answer_ in everywhere(open_, Authorization=f"Bearer {TOKEN}"):
        refused(answer_, 401)


def test_the_token_once_and_then_a_cookie(open_: Address) -> None:
    greeted = open_.get(f"/?token={TOKEN}")
    assert guarded(greeted).status == 303
    assert greeted.headers["location"] == "/"  # the token is not left in the address
    cookie = greeted.headers["set-cookie"]
    parts = {part.strip().lower() for part in cookie.split(";")[1:]}
    assert {"httponly", "samesite=strict", "path=/"} <= parts
    held = {"Cookie": cookie.partition(";")[0]}
    assert TOKEN.encode() not in greeted.body
    for path in READ[:-1]:
        answer = open_.get(path, **held)
        assert guarded(answer).status == 200, path
        assert TOKEN.encode() not in answer.body
    assert open_.ask("POST", "/api/cancel", {}, held).status == 200
    assert open_.get("/api/status", Host="ship.example", **held).status == 200


def test_the_cookie_is_of_no_use_to_another_site(open_: Address) -> None:
    held = {"Cookie": f"trialid-{open_.port}={TOKEN}"}
    for more in ({"Origin": "http://evil.example"}, {"Sec-Fetch-Site": "cross-site"}):
        for answer in everywhere(open_, **held, **more):
            refused(answer, 403)
    kind = {"Content-Type": "text/plain"}
    refused(open_.ask("POST", "/api/cancel", b"{}", {**held, **kind}), 415)


# --- what is not there --------------------------------------------------------------------------


PATHS = (
    "/../../etc/passwd", "/..", "/../", "//etc/passwd", "///etc/passwd", "/etc/passwd",
    "/%2e%2e/%2e%2e/etc/passwd", "/%2E%2E%2Fetc%2Fpasswd", "/..%2f..%2fetc%2fpasswd",
    "/..%5c..%5cetc%5cpasswd", "/..\\..\\etc\\passwd", "/....//....//etc/passwd",
    "/%252e%252e/etc/passwd", "/workbench.css/../../desk.py", "/workbench.css/..%2f..%2fdesk.py",
    "/static/workbench.css", "/./workbench.css", "/workbench.css%00", "/workbench.css%00.js",
    "/workbench.css/", "/quick.toml", "/s175q.toml", "/log.csv", "/desk.py", "/%00", "/\xff",
    "http://evil.example/etc/passwd", "*", "/api", "/api/", "/api/../../../etc/passwd",
    "/api/series/", "/api/series/-1", "/api/series/+1", "/api/series/1.0", "/api/series/99",
    "/api/series/" + 20 * "9", "/api/series/" + 5000 * "9", "/api/series/0/..%2f..",
    "/api/series/%2e%2e", "/api/series/\xb2", "/api/series/%C2%B2", "/api/series/%D9%A1",
    "/api/edit", "/api/nothing", "/API/STATUS", "/uplot/uPlot.min.css",
)  # fmt: skip


@pytest.mark.parametrize("path", PATHS, ids=lambda path: repr(path[:40]))
def test_no_address_gives_another_file(own: Address, path: str) -> None:
    for method in ("GET", "HEAD", "PUT", "DELETE", "OPTIONS"):
        head = (
            f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{own.port}\r\nConnection: close\r\n\r\n"
        )
        answer = own.raw(head.encode("latin-1"))
        assert answer[:9] == b"HTTP/1.1 ", answer
        assert answer[9:12] in (b"400", b"404", b"405"), answer
        assert b"root:" not in answer
        assert b"import" not in answer
    assert own.get("/api/status").status == 200


def test_every_address_is_of_the_page_or_the_desk(own: Address) -> None:
    for name, (_, path) in ASSETS.items():
        answer = own.get(f"/{name}")
        assert guarded(answer).status == 200
        assert answer.body
        kind = "text/css" if path.endswith(".css") else "text/javascript"
        assert answer.headers["content-type"] == f"{kind}; charset=utf-8"
        assert own.post(f"/{name}", {}).status == 405
