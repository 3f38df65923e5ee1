"""What PrairieLearn accepts as results.json, as a JSON Schema.

Source: PrairieLearn, "External Grading", https://docs.prairielearn.com/externalGrading/ ("Grading results")
"""

import json

from jsonschema import Draft202012Validator

IMAGES = {
    "type": "array",
    "items": {
        "anyOf": [
            {"type": "string"},
            {
                "type": "object",
                "required": ["url"],
                "properties": {
                    "url": {"type": "string", "pattern": "^data:image/[a-z+]+;base64,[A-Za-z0-9+/]+=*$"},
                    "label": {"type": "string"},
                },
            },
        ]
    },
}
TEXT = {"type": "string"}
TEST = {
    "type": "object",
    "required": ["name", "points", "max_points"],
    "properties": {
        "name": TEXT,
        "description": TEXT,
        "points": {"type": "number", "minimum": 0},
        "max_points": {"type": "number", "minimum": 0},
        "message": TEXT,
        "output": TEXT,
        "images": IMAGES,
    },
}
SCHEMA = {
    "type": "object",
    "properties": {
        "gradable": {"type": "boolean"},
        "score": {"type": "number", "minimum": 0, "maximum": 1},
        "message": TEXT,
        "output": TEXT,
        "format_errors": {"anyOf": [TEXT, {"type": "array", "items": TEXT}]},
        "images": IMAGES,
        "tests": {"type": "array", "items": TEST},
    },
    "if": {"properties": {"gradable": {"const": False}}, "required": ["gradable"]},
    "else": {"required": ["score"]},
}


def read(text):
    """Return results that PrairieLearn accepts; fail if it does not."""
    assert len(text.encode()) <= 1_000_000
    data = json.loads(text)
    Draft202012Validator(SCHEMA).validate(data)
    return data
