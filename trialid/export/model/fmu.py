"""A fitted model as an FMI 2.0 co-simulation FMU: C source, with a Linux binary where it can be.

Parameters are tunable, inputs are held over a step; beyond what the trials held the output `unseen`
is true and the log says so. What was seen, how sure the numbers are and where they come from stand
in the annotations and, whole, in `resources/model.json`.
"""

import hashlib
import platform
import shutil
import subprocess
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Iterator, Mapping
from io import BytesIO
from pathlib import Path
from string import Template
from typing import Final
from xml.sax.saxutils import quoteattr

from trialid.errors import TrialidError
from trialid.export.model.c_text import c_texts
from trialid.export.model.equation_steps import own_name
from trialid.export.model.fitted_model import FittedModel
from trialid.export.model.fmi_interface import INTERFACE, TYPES
from trialid.export.model.json_model import model_file
from trialid.names import labels
from trialid.result.json_file import text_of
from trialid.version import VERSION

UNSEEN: Final = "unseen"
BASE: Final[Mapping[str, str]] = {
    "1": "",
    "rad": 'rad="1"',
    "m": 'm="1"',
    "s": 's="1"',
    "m/s": 'm="1" s="-1"',
    "rad/s": 'rad="1" s="-1"',
    "1/s": 's="-1"',
    "1/m": 'm="-1"',
    "N": 'kg="1" m="1" s="-2"',
    "N m": 'kg="1" m="2" s="-2"',
    "m/s^2": 'm="1" s="-2"',
    "rad/s^2": 'rad="1" s="-2"',
}
"""Units in those of the standard; others are named and no more."""
WRITTEN: Final = (1980, 1, 1, 0, 0, 0)
"""Date of every file inside: the same model gives the same bytes."""


def fmu_bytes(made: FittedModel, name: str) -> bytes:
    """The FMU; `name` is that of its file."""
    low = own_name(name).lower()
    guid = _guid(made, low)
    source = fmu_source(made, low, guid)
    files = {
        "modelDescription.xml": _description(made, low, guid).encode(),
        f"sources/{low}.c": source.encode(),
        "resources/model.json": text_of(model_file(made)).encode(),
    }
    binary = _linux_binary(source)
    if binary is not None:
        files[f"binaries/linux64/{low}.so"] = binary
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        for path, content in files.items():
            packed.writestr(zipfile.ZipInfo(path, WRITTEN), content, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def fmu_source(made: FittedModel, low: str, guid: str) -> str:
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
        "GUID": guid,
        "PERIOD": repr(made.period),
    }
    return f"{model}\n{TYPES}\n{Template(INTERFACE).substitute(given)}"


def _guid(made: FittedModel, low: str) -> str:
    digest = hashlib.sha256(f"{low}{VERSION}{text_of(model_file(made))}".encode()).digest()
    return "{" + str(uuid.UUID(bytes=digest[:16])) + "}"


def _linux_binary(source: str) -> bytes | None:
    """The source compiled, None where this is no Linux on a PC or there is no compiler.

    Raises
    ------
    TrialidError
        There is one, and it fails.
    """
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None or sys.platform != "linux" or platform.machine() != "x86_64":
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "model.c")
        path.write_text(source, encoding="utf-8")
        options = ["-O2", "-shared", "-fPIC", "-fvisibility=hidden", "-o", "model.so", "model.c"]
        told = subprocess.run(
            [compiler, *options, "-lm"], cwd=folder, capture_output=True, text=True, check=False
        )
        if told.returncode:
            raise TrialidError(f"{compiler} cannot compile the FMU: {told.stderr.strip()}")
        return Path(folder, "model.so").read_bytes()


def _description(made: FittedModel, low: str, guid: str) -> str:
    variables = [*_variables(made)]
    outputs = [i for i, (kind, _) in enumerate(variables, start=1) if kind in ("state", "output")]
    unknown = [i for i, (kind, _) in enumerate(variables, start=1) if kind == "output"]
    words = " ".join(made.words) or "fitted by trialid"
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<fmiModelDescription fmiVersion="2.0" modelName={quoteattr(low)} '
            f'guid="{guid}" description={quoteattr(f"{made.name}: {words}")} '
            f'generationTool="trialid {VERSION}" variableNamingConvention="flat">',
            f'<CoSimulation modelIdentifier="{low}" canHandleVariableCommunicationStepSize="true" '
            'canGetAndSetFMUstate="true" canBeInstantiatedOnlyOncePerProcess="false">',
            f'<SourceFiles><File name="{low}.c"/></SourceFiles></CoSimulation>',
            *_units(made),
            "<LogCategories>",
            '<Category name="logStatusWarning"/><Category name="logStatusError"/>',
            "</LogCategories>",
            f'<DefaultExperiment startTime="0" stopTime="600" stepSize="{made.period!r}"/>',
            *_annotations(made),
            "<ModelVariables>",
            *(text for _, text in variables),
            "</ModelVariables>",
            "<ModelStructure>",
            "<Outputs>",
            *(f'<Unknown index="{i}"/>' for i in outputs),
            "</Outputs>",
            "<InitialUnknowns>",
            *(f'<Unknown index="{i}"/>' for i in unknown),
            "</InitialUnknowns>",
            "</ModelStructure>",
            "</fmiModelDescription>",
            "",
        ]
    )


def _units(made: FittedModel) -> Iterator[str]:
    signals = (*made.equations.states, *made.inputs, *made.equations.outputs)
    names = dict.fromkeys(
        [*(labels.quantity(n).unit for n in signals), *(p.unit for p in made.parameters)]
    )
    yield "<UnitDefinitions>"
    for unit in names:
        base = f"<BaseUnit {BASE[unit]}/>" if unit in BASE else ""
        yield f"<Unit name={quoteattr(unit)}>{base}</Unit>"
    yield "</UnitDefinitions>"


def _annotations(made: FittedModel) -> Iterator[str]:
    """What was seen, how sure the numbers are, where they come from."""
    reliable = str(made.reliable).lower()
    yield '<VendorAnnotations><Tool name="trialid">'
    yield f'<Model file="resources/model.json" reliable="{reliable}">'
    for key, words in made.origin.items():
        yield f"<Origin key={quoteattr(key)} value={quoteattr(words)}/>"
    yield from (f"<Note text={quoteattr(words)}/>" for words in made.words)
    for name, seen in made.seen.items():
        yield f'<Seen name={quoteattr(name)} low="{seen.low!r}" high="{seen.high!r}"/>'
    for p in (p for p in made.fitted if p.likely is not None):
        low, high = p.likely or (0.0, 0.0)
        yield f'<Likely name={quoteattr(p.name)} low="{low!r}" high="{high!r}"/>'
    yield f"<Covariance of={quoteattr(' '.join(p.name for p in made.fitted))}>"
    yield from (f"<Row>{' '.join(map(repr, row))}</Row>" for row in made.covariance.tolist())
    yield "</Covariance></Model></Tool></VendorAnnotations>"


HOW: Final = {
    "state": 'causality="output" variability="continuous" initial="exact"',
    "input": 'causality="input" variability="continuous"',
    "output": 'causality="output" variability="continuous" initial="calculated"',
    "parameter": 'causality="parameter" variability="tunable" initial="exact"',
    "flag": 'causality="output" variability="discrete" initial="calculated"',
}


def _variables(made: FittedModel) -> Iterator[tuple[str, str]]:
    """Kind and element of every variable, in the order of their references."""
    numbers = (*_signals(made), *_parameters(made))
    for reference, (kind, name, words, real) in enumerate(numbers):
        yield kind, _variable(name, reference, words, HOW[kind], real)
    words = "whether anything was beyond what the trials held"
    yield "output", _variable(UNSEEN, len(numbers), words, HOW["flag"], "<Boolean/>")


def _signals(made: FittedModel) -> Iterator[tuple[str, str, str, str]]:
    """Kind, name, words and number of states, inputs and what the sensors show."""
    starts = made.starts
    for name, start in starts.items():
        known = labels.quantity(name)
        kind = "input" if name in made.inputs else "state"
        yield kind, name, known.meaning, f'<Real unit={quoteattr(known.unit)} start="{start!r}"/>'
    for name in made.equations.outputs:
        known = labels.quantity(name)
        words = f"{known.meaning}, as its sensor shows it"
        yield "output", f"{name}_sensor", words, f"<Real unit={quoteattr(known.unit)}/>"


def _parameters(made: FittedModel) -> Iterator[tuple[str, str, str, str]]:
    """Kind, name, words and number of the parameters."""
    for p in made.parameters:
        words = "fitted, nobody knows how sure" if p.fitted else "held fixed"
        if p.likely is not None:
            words = f"fitted, likely {p.likely[0]:.4g} to {p.likely[1]:.4g}"
        yield "parameter", p.name, words, f'<Real unit={quoteattr(p.unit)} start="{p.value!r}"/>'


def _variable(name: str, reference: int, words: str, how: str, kind: str) -> str:
    return (
        f'<ScalarVariable name={quoteattr(name)} valueReference="{reference}" '
        f"description={quoteattr(words)} {how}>{kind}</ScalarVariable>"
    )
