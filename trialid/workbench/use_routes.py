"""Addresses at which the model on the screen is used: a manoeuvre tried, a file handed out."""

from typing import Any, Final

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from trialid.workbench.sent import sent_object, text_in
from trialid.workbench.use_desk import hand_out, try_orders
from trialid.workflow.use.finished_model import FinishedModel


def _ready(request: Request) -> FinishedModel:
    found: FinishedModel = request.app.state.in_use.model(request.app.state.desk.shown)
    return found


async def _model(request: Request) -> Response:
    """The model in one of its forms."""

    def made() -> tuple[str, bytes]:
        return hand_out(_ready(request), request.path_params["kind"], dict(request.query_params))

    name, content = await run_in_threadpool(made)
    told = {"content-disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type="application/octet-stream", headers=told)


async def _try(request: Request) -> Response:
    """A manoeuvre of the model on the screen."""
    asked = await sent_object(request) or {}

    def made() -> dict[str, Any]:
        words = text_in(asked, "orders")
        return try_orders(_ready(request), words)

    return JSONResponse(await run_in_threadpool(made))


ROUTES: Final = (
    Route("/model/{kind}", _model),
    Route("/api/try", _try, methods=["POST"]),
)
