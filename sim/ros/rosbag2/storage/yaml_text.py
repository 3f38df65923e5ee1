"""YAML as bags have it: written in full, and read from files of unknown origin."""

from __future__ import annotations

from typing import Any

import yaml

from gz_course.sim.ros.rosbag2.errors import BagError


def to_yaml(value: Any) -> str:
    return yaml.dump(value, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=4096)


class _Dumper(yaml.CSafeDumper):
    """Writes each list and dictionary in full, because readers in C++ need not know of YAML's aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def load_yaml(text: str, name: str) -> Any:
    """Read YAML of unknown origin. Raises BagError."""
    try:
        if any(isinstance(event, yaml.AliasEvent) for event in yaml.parse(text, Loader=yaml.CSafeLoader)):
            raise BagError(f"{name} has YAML aliases, which no bag has")
        return yaml.load(text, Loader=yaml.CSafeLoader)
    except (yaml.YAMLError, ValueError, RecursionError, MemoryError, OverflowError) as error:
        mark = getattr(error, "problem_mark", None)
        line = f":{mark.line + 1}" if mark is not None else ""
        raise BagError(f"{name}{line}: this is not YAML: {getattr(error, 'problem', None) or error}") from None
