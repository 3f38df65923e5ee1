"""The class of a type in a message definition."""

from __future__ import annotations

import importlib
from typing import Any

from rosidl_parser.definition import NamespacedType

_FEEDBACK = "_FeedbackMessage"


def import_message_from_namespaced_type(message_type: NamespacedType) -> Any:
    """Return the class. Raises ImportError for an unknown package, AttributeError for an unknown name in it."""
    module = importlib.import_module(".".join(message_type.namespaces))
    if message_type.name.endswith(_FEEDBACK):
        return getattr(module, message_type.name.removesuffix(_FEEDBACK)).Impl.FeedbackMessage
    return getattr(module, message_type.name)
