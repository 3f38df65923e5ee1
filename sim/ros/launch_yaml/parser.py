"""Reads launch files in YAML."""

from __future__ import annotations

import os
from typing import Any, TextIO

import yaml

from gz_course.sim.ros.launch import frontend
from gz_course.sim.ros.launch.frontend.entity import LaunchText
from gz_course.sim.ros.launch.frontend.parser import InvalidFrontendLaunchFileError, source_of
from gz_course.sim.ros.launch_yaml.entity import Entity, Mapping

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class Parser(frontend.Parser):
    """The parser of launch files in YAML."""

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        return {"launch.yaml"}

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the root element of a file. Raises InvalidFrontendLaunchFileError."""
        return _root(source_of(file)), cls()

    @classmethod
    def load_text(cls, text: str, path: str) -> tuple[Entity, Parser]:
        return _root(LaunchText(path, text)), cls()


def _root(source: LaunchText) -> Entity:
    value, place = _read(source)
    if not isinstance(value, Mapping) or len(value) != 1 or not isinstance(next(iter(value)), str):
        seen = f"keys {', '.join(map(str, value))}" if isinstance(value, Mapping) else f"a {type(value).__name__}"
        raise InvalidFrontendLaunchFileError(
            f"{source.path}:{place}: a launch file in YAML has one key, `launch:`, and below it a list; this has {seen}"
        )
    name = next(iter(value))
    return Entity(value[name], name, source=source, where=value.places[name])


def _read(source: LaunchText) -> tuple[Any, str]:
    """Return the value of the file and its place. Raises InvalidFrontendLaunchFileError."""
    try:
        loader = _LOADER(source.text)
        try:
            node = loader.get_single_node()
            if node is None:
                raise InvalidFrontendLaunchFileError(f"{source.path}:1:1: the file is empty; `launch:` is expected")
            return _Values(loader).of(node), _place(node)
        finally:
            loader.dispose()
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f":{mark.line + 1}:{mark.column + 1}" if mark is not None else ""
        what = getattr(error, "problem", None) or getattr(error, "reason", None) or str(error).partition("\n")[0]
        raise InvalidFrontendLaunchFileError(f"{source.path}{place}: this is no YAML: {what}") from None
    except RecursionError:
        raise InvalidFrontendLaunchFileError(f"{source.path}: the lists and mappings are nested too deeply") from None
    except (ValueError, TypeError, OverflowError, AttributeError, LookupError) as error:  # such as a date of month 13
        raise InvalidFrontendLaunchFileError(f"{source.path}: a value means nothing: {error}") from None


class _Values:
    """Python values of YAML's nodes; mappings keep the places of their keys."""

    def __init__(self, loader: Any) -> None:
        self._loader = loader
        self._done: dict[int, Any] = {}

    def of(self, node: Any) -> Any:
        if id(node) not in self._done:
            self._done[id(node)] = self._new(node)
        return self._done[id(node)]

    def _new(self, node: Any) -> Any:
        if isinstance(node, yaml.SequenceNode):
            return [self.of(item) for item in node.value]
        if not isinstance(node, yaml.MappingNode):
            return self._loader.construct_object(node, deep=True)
        self._loader.flatten_mapping(node)
        result = Mapping()
        for key, value in node.value:
            name = self.of(key)
            if isinstance(name, list | Mapping):
                raise yaml.constructor.ConstructorError(None, None, "a key must be text", key.start_mark)
            result[name] = self.of(value)
            result.places[name] = _place(key)
        return result


def _place(node: Any) -> str:
    return f"{node.start_mark.line + 1}:{node.start_mark.column + 1}"
