"""`modelDescription.xml` of FMI 2.0 (2.0.4, `fmi2ModelDescription.xsd`)."""

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


def fmi2_description(made: FittedModel, low: str, token: str) -> str:
    """The file; `token` is what the binary wants to hear."""
    variables = variables_of(made)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<fmiModelDescription fmiVersion="2.0" modelName={quoteattr(low)} '
        f'guid="{token}" description={description(made)} '
        f'generationTool="trialid {VERSION}" variableNamingConvention="flat">',
        f'<CoSimulation modelIdentifier="{low}" canHandleVariableCommunicationStepSize="true" '
        'canGetAndSetFMUstate="true" canBeInstantiatedOnlyOncePerProcess="false">',
        f'<SourceFiles><File name="{low}.c"/></SourceFiles></CoSimulation>',
        *units_of(variables),
        "<LogCategories>",
        '<Category name="logStatusWarning"/><Category name="logStatusError"/>',
        "</LogCategories>",
        f'<DefaultExperiment startTime="0" stopTime="600" stepSize="{made.period!r}"/>',
        '<VendorAnnotations><Tool name="trialid">',
        *known_of(made),
        "</Tool></VendorAnnotations>",
        "<ModelVariables>",
        *(_variable(i, v) for i, v in enumerate(variables)),
        "</ModelVariables>",
        "<ModelStructure>",
        "<Outputs>",
        *(f'<Unknown index="{i}"/>' for i, v in enumerate(variables, 1) if v.is_output),
        "</Outputs>",
        "<InitialUnknowns>",
        *(
            f'<Unknown index="{i}"/>'
            for i, v in enumerate(variables, 1)
            if v.is_output and v.start is None
        ),
        "</InitialUnknowns>",
        "</ModelStructure>",
        "</fmiModelDescription>",
    ]
    return "\n".join(lines) + "\n"


def _variable(reference: int, v: Variable) -> str:
    number = "<Boolean/>" if v.kind == "flag" else f"<Real{v.attributes}/>"
    return (
        f'<ScalarVariable name={quoteattr(v.name)} valueReference="{reference}" '
        f"description={quoteattr(v.words)} {v.how}>{number}</ScalarVariable>"
    )
