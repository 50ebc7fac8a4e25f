"""The workbench's page and its JSON interface, on one address of this machine."""

import asyncio
import json
import socket
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import cache
from importlib import resources
from typing import Any, Final

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from trialid.errors import TrialidError
from trialid.report import script
from trialid.report.pages.page import page
from trialid.result.json_file import plain
from trialid.workbench import guide_page, screen, use_routes
from trialid.workbench.desk import Desk
from trialid.workbench.document import Outdated
from trialid.workbench.guard import Guard, of_this_machine
from trialid.workbench.hand_out import copy_pipeline, write_folder
from trialid.workbench.sent import sent_object, text_in
from trialid.workbench.use_desk import InUse

SCRIPTS: Final = tuple(
    [
        "workbench",
        "state",
        "complaints",
        "parts",
        "trials",
        "status",
        "edits",
        "keys",
        "use",
        "tried",
    ]
)
"""The modules of the page's own script."""

ASSETS: Final[Mapping[str, tuple[str, str]]] = {
    "workbench.css": ("trialid.workbench", "static/workbench.css"),
    **{f"{name}.js": ("trialid.workbench", f"static/{name}.js") for name in SCRIPTS},
    "page.css": ("trialid.report", "page.css"),
    **{name: ("trialid.report", name) for name in script.MODULES if name != "page.js"},
    "uplot.css": ("trialid.report", "uplot/uPlot.min.css"),
    "uplot.js": ("trialid.report", "uplot/uPlot.iife.min.js"),
}
"""Every file that can be asked for: there is no other, whatever the address."""

TICK: Final = 0.05
"""Between two looks at the desk for a page that listens [s]."""

BEAT: Final = 15.0
"""Without news for so long [s] a listening page is told that the workbench is there."""


def application(desk: Desk, token: str | None = None, *, local: bool = False) -> Guard:
    """The workbench as an ASGI application; without a token for this machine's names only."""
    routes = [
        Route("/", _page),
        *(Route(f"/{name}", _asset) for name in ASSETS),
        Route("/report.html", _report),
        Route("/pipeline.toml", _pipeline),
        Route("/guide", _guide),
        Route("/guide/{topic}", _guide),
        Route("/api/events", _events),
        Route("/api/status", _status),
        Route("/api/screen", _screen),
        Route("/api/series/{index}", _series),
        Route("/api/result", _result),
        *use_routes.ROUTES,
        *(Route(f"/api/{name}", _post(act), methods=["POST"]) for name, act in ACTS.items()),
    ]
    app = Starlette(routes=routes, exception_handlers={TrialidError: _refused})
    app.router.redirect_slashes = False
    app.state.desk, app.state.in_use = desk, InUse()
    return Guard(app, token, local or token is None)


class _Server(uvicorn.Server):
    """Ends the pages' news before it waits for them."""

    def __init__(self, config: uvicorn.Config, desk: Desk) -> None:
        super().__init__(config)
        self._desk = desk

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Close the desk, then the connections."""
        self._desk.close()
        await super().shutdown(sockets)


def serve(desk: Desk, listening: socket.socket, token: str) -> None:
    """Answer until Ctrl-C."""
    config = uvicorn.Config(
        application(desk, token, local=of_this_machine(listening.getsockname()[0])),
        log_level="warning",
        lifespan="off",
        timeout_graceful_shutdown=1,
        server_header=False,
    )
    try:
        with suppress(KeyboardInterrupt):  # the way to end it, which is no failure
            _Server(config, desk).run(sockets=[listening])
    finally:
        desk.close()


def _desk(request: Request) -> Desk:
    return request.app.state.desk


def _page(request: Request) -> Response:
    return Response(screen.page(_desk(request).shown), media_type="text/html")


def _asset(request: Request) -> Response:
    name = request.url.path.removeprefix("/")
    kind = "text/css" if name.endswith(".css") else "text/javascript"
    return Response(_content(name), media_type=kind)


@cache
def _content(name: str) -> bytes:
    package, path = ASSETS[name]
    return resources.files(package).joinpath(path).read_bytes()


def _plain_status(desk: Desk) -> dict[str, Any]:
    return asdict(desk.status)


def _status(request: Request) -> Response:
    return JSONResponse(_plain_status(_desk(request)))


async def _events(request: Request) -> Response:
    return StreamingResponse(_news(request), media_type="text/event-stream")


async def _news(request: Request) -> AsyncIterator[str]:
    """Every new status as an event, at most one a tick."""
    desk, serial, silent = _desk(request), -1, 0.0
    while not desk.closed:
        status = _plain_status(desk)
        if status["serial"] != serial:
            serial, silent = status["serial"], 0.0
            yield f"data: {json.dumps(status)}\n\n"
        elif silent >= BEAT:
            silent = 0.0
            yield ": here\n\n"
        await asyncio.sleep(TICK)
        silent += TICK


def _screen(request: Request) -> Response:
    desk = _desk(request)
    status, shown = desk.status, desk.shown
    return JSONResponse(
        {
            "screen": status.screen,
            "version": status.version,
            "parts": screen.parts(shown),
            "facts": screen.facts(shown),
        }
    )


def _series(request: Request) -> Response:
    desk = _desk(request)
    count, shown = desk.status.series, desk.shown
    wanted = request.path_params["index"]
    index = next((i for i in range(len(shown.series)) if str(i) == wanted), None)
    if index is None:
        return JSONResponse({"error": "there is no such trial"}, status_code=404)
    return JSONResponse({"series": count, **screen.panels(shown, index)})


def _result(request: Request) -> Response:
    run = _desk(request).shown.run
    if run is None:
        return JSONResponse({"error": "not known yet"}, status_code=404)
    return JSONResponse(plain(run.result))


def _report(request: Request) -> Response:
    run = _desk(request).shown.run
    if run is None:
        return JSONResponse({"error": "not known yet"}, status_code=404)
    return _download(page(run.result, run.series, run.forces), "report.html", "text/html")


def _pipeline(request: Request) -> Response:
    pipeline = _desk(request).shown.pipeline
    return _download(pipeline.text, "pipeline.toml", "application/toml")


def _guide(request: Request) -> Response:
    """A page of the manual; links between pages end in .md, as in its files."""
    topic = request.path_params.get("topic")
    try:
        return Response(guide_page.html_page(topic), media_type="text/html")
    except TrialidError as error:
        return JSONResponse({"error": str(error)}, status_code=404)


def _download(text: str, name: str, kind: str) -> Response:
    told = {"content-disposition": f'attachment; filename="{name}"'}
    return Response(text, media_type=kind, headers=told)


Act = Callable[[Desk, dict[str, Any]], dict[str, Any]]


def _post(act: Act) -> Callable[[Request], Any]:
    async def answered(request: Request) -> Response:
        asked = await sent_object(request)
        if asked is None:
            return JSONResponse({"error": "send one JSON object", "kind": "invalid"}, 400)
        desk = _desk(request)
        said = await run_in_threadpool(act, desk, asked)
        return JSONResponse({**_plain_status(desk), **said})

    return answered


def _edit(desk: Desk, asked: dict[str, Any]) -> dict[str, Any]:
    desk.edit(asked)
    return {}


def _undo(desk: Desk, asked: dict[str, Any]) -> dict[str, Any]:
    desk.undo(text_in(asked, "version"))
    return {}


def _redo(desk: Desk, asked: dict[str, Any]) -> dict[str, Any]:
    desk.redo(text_in(asked, "version"))
    return {}


def _cancel(desk: Desk, asked: dict[str, Any]) -> dict[str, Any]:
    desk.cancel()
    return {}


def _again(desk: Desk, asked: dict[str, Any]) -> dict[str, Any]:
    desk.again()
    return {}


def _export(desk: Desk, asked: dict[str, Any]) -> dict[str, Any]:
    shown = desk.shown
    name = asked.get("name")
    if name is not None:
        return {"files": [copy_pipeline(shown.pipeline, text_in(asked, "name"))]}
    return {"files": write_folder(shown)}


ACTS: Final[Mapping[str, Act]] = {
    "edit": _edit, "undo": _undo, "redo": _redo, "cancel": _cancel, "again": _again,
    "export": _export,
}  # fmt: skip


async def _refused(request: Request, error: Exception) -> Response:
    """The user's mistake, in one line, to be shown where it was made."""
    kind, status = ("changed", 409) if isinstance(error, Outdated) else ("refused", 400)
    words = " ".join(str(error).split()).removeprefix(f"{_desk(request).path}: ")
    return JSONResponse({"error": words, "kind": kind}, status_code=status)
