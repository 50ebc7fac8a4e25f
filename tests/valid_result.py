"""What every `result.json` must be: of its JSON Schema, and the same when read and written."""

import json
from functools import cache
from typing import Any

import jsonschema

from trialid.result.json_file import json_schema, result_of, text_of


@cache
def validator() -> jsonschema.Draft202012Validator:
    """The schema that is derived from the rows, itself checked."""
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def assert_valid(result: dict[str, Any]) -> None:
    """The content of a file conforms, and nothing of it is lost on the way through the rows."""
    wrong = [f"{e.json_path}: {e.message}" for e in validator().iter_errors(result)]
    assert wrong == []
    assert json.loads(text_of(result_of(result))) == result
