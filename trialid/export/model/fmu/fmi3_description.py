"""`modelDescription.xml` and `buildDescription.xml` of FMI 3.0 (`fmi3ModelDescription.xsd`)."""

from typing import Final
from xml.sax.saxutils import quoteattr

from trialid.export.model.fitted_model import FittedModel
from trialid.export.model.fmu.variables import (
    Variable,
    description,
    known_of,
    units_of,
    variables_of,
)
from trialid.version import VERSION

ANNOTATION: Final = "trialid.model"
"""What our annotation is called; in reverse of a domain, or like it."""


def fmi3_description(made: FittedModel, low: str, token: str) -> str:
    """The file; `token` is what the binary wants to hear."""
    variables = variables_of(made)
    outputs = [(i, v) for i, v in enumerate(variables) if v.is_output]
    unknown = [(i, v) for i, v in outputs if v.start is None]
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<fmiModelDescription fmiVersion="3.0" modelName={quoteattr(low)} '
        f'instantiationToken="{token}" description={description(made)} '
        f'generationTool="trialid {VERSION}" variableNamingConvention="flat">',
        f'<CoSimulation modelIdentifier="{low}" canHandleVariableCommunicationStepSize="true" '
        'canGetAndSetFMUState="true" canBeInstantiatedOnlyOncePerProcess="false"/>',
        *units_of(variables),
        "<LogCategories>",
        '<Category name="logStatusWarning"/><Category name="logStatusError"/>',
        "</LogCategories>",
        f'<DefaultExperiment startTime="0" stopTime="600" stepSize="{made.period!r}"/>',
        "<ModelVariables>",
        *(_variable(i, v) for i, v in enumerate(variables)),
        f'<Float64 name="time" valueReference="{len(variables)}" causality="independent" '
        'variability="continuous" unit="s"/>',
        "</ModelVariables>",
        "<ModelStructure>",
        *(f'<Output valueReference="{i}"/>' for i, _ in outputs),
        *(f'<InitialUnknown valueReference="{i}"/>' for i, _ in unknown),
        "</ModelStructure>",
        f'<Annotations><Annotation type="{ANNOTATION}">',
        *known_of(made),
        "</Annotation></Annotations>",
        "</fmiModelDescription>",
    ]
    return "\n".join(lines) + "\n"


def _variable(reference: int, v: Variable) -> str:
    kind = "Boolean" if v.kind == "flag" else "Float64"
    return (
        f'<{kind} name={quoteattr(v.name)} valueReference="{reference}" '
        f"description={quoteattr(v.words)} {v.how}{v.attributes}/>"
    )


def build_description(low: str) -> str:
    """How the source is to be compiled."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<fmiBuildDescription fmiVersion="3.0">\n'
        f'<BuildConfiguration modelIdentifier="{low}"><SourceFileSet language="C99">\n'
        f'<SourceFile name="{low}.c"/>\n'
        "</SourceFileSet></BuildConfiguration>\n"
        "</fmiBuildDescription>\n"
    )
