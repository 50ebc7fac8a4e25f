"""A fitted model as an FMU for co-simulation, of FMI 2.0 or 3.0: C source, binaries where they can.

Parameters are tunable, inputs are held over a step; beyond what the trials held the output `unseen`
is true and the log says so. What was seen, how sure the numbers are and where they come from stand
in the annotations and, whole, in `resources/model.json`.
"""

import hashlib
import uuid
import zipfile
from io import BytesIO
from string import Template
from typing import Final, Literal

from trialid.export.model.c_text import c_texts
from trialid.export.model.equation_steps import own_name
from trialid.export.model.fitted_model import FittedModel
from trialid.export.model.fmu import fmi2_interface, fmi3_interface
from trialid.export.model.fmu.binaries import binaries
from trialid.export.model.fmu.core import CORE, PLATFORM
from trialid.export.model.fmu.fmi2_description import fmi2_description
from trialid.export.model.fmu.fmi3_description import build_description, fmi3_description
from trialid.export.model.json_model import model_file
from trialid.result.json_file import text_of
from trialid.version import VERSION

Fmi = Literal["2.0", "3.0"]
WRITTEN: Final = (1980, 1, 1, 0, 0, 0)
"""Date of every file inside: the same model gives the same bytes."""


def fmu_bytes(
    made: FittedModel, name: str, version: Fmi = "2.0", *, everywhere: bool = False
) -> bytes:
    """The FMU.

    Parameters
    ----------
    name
        That of its file.
    version
        Of FMI.
    everywhere
        With binaries for Windows and macOS too, where their compiler is installed.
    """
    low = own_name(name).lower()
    token = _token(made, low)
    source = fmu_source(made, low, token, version)
    describe = fmi2_description if version == "2.0" else fmi3_description
    files = {
        "modelDescription.xml": describe(made, low, token).encode(),
        f"sources/{low}.c": source.encode(),
        "resources/model.json": text_of(model_file(made)).encode(),
    }
    if version == "3.0":
        files["sources/buildDescription.xml"] = build_description(low).encode()
    files |= binaries(source, low, version, everywhere=everywhere)
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        for path, content in files.items():
            packed.writestr(zipfile.ZipInfo(path, WRITTEN), content, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def fmu_source(made: FittedModel, low: str, token: str, version: Fmi = "2.0") -> str:
    """The whole in one C file."""
    texts = c_texts(made, low)
    model = texts[".c"].replace(f'#include "{low}.h"\n', texts[".h"])
    eq = made.equations
    start = [*made.starts.values(), *(0.0 for _ in eq.outputs)]
    start += [p.value for p in made.parameters]
    given = {
        "NX": len(eq.states),
        "NU": len(made.inputs),
        "NY": len(eq.outputs),
        "NP": len(made.parameters),
        "START": ",\n    ".join(map(repr, start)),
        "LOW": low,
        "UP": low.upper(),
        "TOKEN": token,
        "PERIOD": repr(made.period),
    }
    interface = fmi2_interface if version == "2.0" else fmi3_interface
    core = Template(CORE).substitute(given)
    return "\n".join([model, PLATFORM, interface.TYPES, core, interface.CALLS])


def _token(made: FittedModel, low: str) -> str:
    """By which a description and its binary know one another."""
    digest = hashlib.sha256(f"{low}{VERSION}{text_of(model_file(made))}".encode()).digest()
    return "{" + str(uuid.UUID(bytes=digest[:16])) + "}"
