"""Finds the Python class of a type, whether it is compiled or made at run time."""

from __future__ import annotations

import functools
import importlib
import re
from typing import Any

from rosidl_parser import definition as idl

_OF_AN_ACTION = re.compile(
    "_(Goal|Result|Feedback|FeedbackMessage|(SendGoal|GetResult)(_Request|_Response|_Event)?)$"
)  # the folder's module does not export all of them


def module_name(interface: str) -> str:
    """Return the module of an interface: `_tf_message` for `TFMessage`.

    Source: rosidl_pycommon 4.6 (`convert_camel_case_to_lower_case_underscore`)
    """
    words = re.sub("(.)([A-Z][a-z]+)", r"\1_\2", interface)
    return "_" + re.sub("([a-z0-9])([A-Z])", r"\1_\2", words).lower()


def nested_class(kind: idl.NamespacedType) -> Any:
    """Return the class of a message type."""
    return class_of("/".join(kind.namespaced_name()))


@functools.cache
def class_of(type_name: str) -> Any:
    """Return the class of `package/kind/Name`."""
    package, kind, name = type_name.split("/")
    if kind == "msg":
        return getattr(importlib.import_module(f"{package}.{kind}"), name)
    interface = _OF_AN_ACTION.sub("", name) if kind == "action" else re.sub("_(Request|Response|Event)$", "", name)
    return getattr(importlib.import_module(f"{package}.{kind}.{module_name(interface)}"), name)
