"""Message types that exist only in a bag: made from the definitions that it holds."""

from __future__ import annotations

import importlib
import os
import re
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gz_course.sim.ros.rosbag2.definitions import ENCODING, parts_of
from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosidl import packages
from gz_course.sim.ros.rosidl.definitions import description
from gz_course.sim.ros.rosidl.nested_classes import class_of
from gz_course.sim.ros.rosidl.package_index import write_index
from gz_course.sim.ros.rosidl.type_description import type_hash

_NAME = re.compile(r"([a-z][a-z0-9_]{0,99})/(msg|srv|action)/([A-Z][A-Za-z0-9_]{0,99})")
_LONGEST = 1 << 20  # characters of a definition


def installed_class(type_name: str) -> Any:
    """Return the class of `package/msg/Name`, or of a message of a service or an action. Raises BagError."""
    match = _NAME.fullmatch(type_name)
    if match is None:
        raise BagError(f"'{type_name}' is not the name of a message type")
    try:
        return class_of(type_name)
    except (ImportError, AttributeError, ValueError, RecursionError) as error:
        raise BagError(f"the type {type_name} is not known here: {str(error).splitlines()[0]}") from None


def service_class(event_type: str) -> Any:
    """Return the class of a service for the type of its events, `package/srv/Name_Event`. Raises BagError."""
    name = event_type.removesuffix("_Event")
    match = _NAME.fullmatch(name)
    if match is None or match[2] != "srv" or name == event_type:
        raise BagError(f"'{event_type}' is not the type of the events of a service")
    try:
        return getattr(importlib.import_module(f"{match[1]}.srv"), match[3])
    except (ImportError, AttributeError) as error:
        raise BagError(f"the service {name} is not known here: {str(error).splitlines()[0]}") from None


def installed_hash(type_name: str) -> str:
    """Return the hash of a type as it is installed here, an empty text if it is unknown."""
    try:
        return type_hash(description(type_name))
    except (ImportError, KeyError, OSError, ValueError):
        return ""


class StoredTypes:
    """Finds the classes of message types; packages that are not installed come from definitions of a bag.

    They are in a folder of its own until the end of its `with` block, and importable in this process from then on.
    """

    def __init__(self, definitions: Mapping[str, tuple[str, str]]) -> None:
        self._definitions = definitions
        self._folder = tempfile.TemporaryDirectory(prefix="rosbag2-types-")
        self._before = os.environ.get("AMENT_PREFIX_PATH")

    def __enter__(self) -> StoredTypes:
        known = packages.packages(packages.ALL)
        texts: dict[str, str] = {}
        for name, (encoding, text) in self._definitions.items():
            if encoding == ENCODING and len(text) <= _LONGEST:
                texts = parts_of(name, text) | texts
        missing = {name: text for name, text in texts.items() if name.partition("/")[0] not in known}
        for name, text in missing.items():
            if (match := _NAME.fullmatch(name)) and match[2] == "msg":
                file = Path(self._folder.name, "share", match[1], "msg", f"{match[3]}.msg")
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8", errors="replace")
        if Path(self._folder.name, "share").is_dir():
            write_index(Path(self._folder.name))
            path = [self._folder.name, *([self._before] if self._before else [])]
            os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(reversed(path))
            importlib.invalidate_caches()
        return self

    def message_class(self, type_name: str) -> Any:
        """Return the class of a message type. Raises BagError with the reason if there is none."""
        try:
            return installed_class(type_name)
        except BagError as error:
            encoding, text = self._definitions.get(type_name, ("", ""))
            if not _NAME.fullmatch(type_name) or (text and encoding == ENCODING):
                raise
            reason = "the bag does not hold its definition"
            if text:
                reason = f"its definition in the bag is in '{encoding}', not in '{ENCODING}'"
            raise BagError(f"{error}, and {reason}") from None

    def __exit__(self, *_: object) -> None:
        if self._before is None:
            os.environ.pop("AMENT_PREFIX_PATH", None)
        else:
            os.environ["AMENT_PREFIX_PATH"] = self._before
        self._folder.cleanup()
