"""Who may talk to the workbench: whoever holds the token, from the workbench's own page.

The token stands in the address that the command prints: on this machine alone, too, there are
other users. It is changed for a cookie, one for each port, as browsers hold them for all ports.

A page of another site can send requests to this machine, and a name can be made to point to it;
both are told by headers that no page can forge.
"""

import hmac
import ipaddress
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

COOKIE: Final = "trialid"
LARGEST: Final = 65536
"""Bytes a request may carry: an edit is a few hundred."""

HEADERS: Final[Mapping[str, str]] = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "connect-src 'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cache-control": "no-store",
}


@dataclass(frozen=True)
class Guard:
    """Lets through what comes from the workbench's own page and knows the token, if there is one.

    `local` where it listens on this machine alone: it is then asked for by its own names only.
    """

    app: ASGIApp
    token: str | None
    local: bool

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        refused = self._refusal(scope)
        if refused is None:
            await self.app(scope, receive, _with_headers(send))
        else:
            await refused(scope, receive, _with_headers(send))

    def _refusal(self, scope: Scope) -> Response | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if self.local and not of_this_machine(_hostname(host)):
            return _no(403, "this workbench answers on this machine only, by its own address")
        if _foreign(headers, host):
            return _no(403, "a request from another page is not answered")
        if self.token is not None and not self._known(scope, headers):
            return self._greeted(scope)
        if scope["method"] == "POST":
            return _refused_body(headers)
        return None

    def _known(self, scope: Scope, headers: Headers) -> bool:
        given = cookie_parser(headers.get("cookie", "")).get(cookie(scope), "")
        return hmac.compare_digest(given.encode(), str(self.token).encode())

    def _greeted(self, scope: Scope) -> Response:
        """The address with the token in it, once: from then on a cookie that no script can read."""
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        if not hmac.compare_digest(given.encode(), str(self.token).encode()):
            return _no(401, "open the whole address that trialid printed, with its token")
        answer = RedirectResponse("/", status_code=303)
        answer.set_cookie(cookie(scope), given, httponly=True, samesite="strict")
        return answer


def _foreign(headers: Headers, host: str) -> bool:
    """Whether another site's page sent it."""
    origin = headers.get("origin")
    if origin is not None and _place(origin) != host:
        return True
    return headers.get("sec-fetch-site", "none") not in ("same-origin", "none")


def _refused_body(headers: Headers) -> Response | None:
    kind = headers.get("content-type", "").partition(";")[0].strip()
    if kind != "application/json":  # what another site's form cannot send unasked
        return _no(415, "send application/json")
    length = headers.get("content-length", "")
    known = re.fullmatch("[0-9]{1,9}", length) and "transfer-encoding" not in headers
    if not known or int(length) > LARGEST:
        return _no(413, f"send at most {LARGEST} bytes, and say how many")
    return None


def _place(origin: str) -> str:
    try:
        return urlsplit(origin).netloc
    except ValueError:  # as of `http://[`
        return ""


def cookie(scope: Scope) -> str:
    """The name of the cookie: of this port."""
    server = scope.get("server") or ("", 0)
    return f"{COOKIE}-{server[1]}"


def of_this_machine(host: str) -> bool:
    """Whether a host is the machine itself, by any of its addresses.

    >>> of_this_machine("127.0.0.2"), of_this_machine("localhost"), of_this_machine("0.0.0.0")
    (True, True, False)
    """
    try:
        return host == "localhost" or ipaddress.ip_address(host.partition("%")[0]).is_loopback
    except ValueError:
        return False


def _hostname(host: str) -> str:
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""


def _no(status: int, words: str) -> Response:
    return PlainTextResponse(f"{words}\n", status_code=status)


def _with_headers(send: Send) -> Send:
    extra = [(name.encode(), value.encode()) for name, value in HEADERS.items()]

    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message["headers"], *extra]}
        await send(message)

    return sending
