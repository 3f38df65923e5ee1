"""Reads launch files in XML."""

from __future__ import annotations

import os
from typing import Any, TextIO
from xml.parsers import expat

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch import frontend
from gz_course.sim.ros.launch.frontend.entity import LaunchText
from gz_course.sim.ros.launch.frontend.parser import InvalidFrontendLaunchFileError, source_of
from gz_course.sim.ros.launch_xml.entity import Entity

_DEEPEST = 200  # tags in each other


class Parser(frontend.Parser):
    """The parser of launch files in XML."""

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        return {"launch.xml"}

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the root element of a file. Raises InvalidFrontendLaunchFileError."""
        return _Reader(source_of(file)).read(), cls()

    @classmethod
    def load_text(cls, text: str, path: str) -> tuple[Entity, Parser]:
        return _Reader(LaunchText(path, text)).read(), cls()


class _Reader:
    """Makes entities of the tags that expat reports."""

    def __init__(self, source: LaunchText) -> None:
        self._source = source
        self._root: Entity | None = None
        self._open: list[Entity] = []
        self._expat = expat.ParserCreate()
        self._expat.StartElementHandler = self._start
        self._expat.EndElementHandler = self._end
        self._expat.CharacterDataHandler = self._text
        self._expat.buffer_text = True

    def read(self) -> Entity:
        try:
            self._expat.Parse(self._source.text, True)
        except expat.ExpatError as error:
            raise InvalidFrontendLaunchFileError(
                f"{self._source.path}:{error.lineno}:{error.offset + 1}: this is no XML: "
                f"{expat.ErrorString(error.code)}{self._still_open()}"
            ) from None
        except ValueError as error:  # an encoding that does not exist
            raise InvalidFrontendLaunchFileError(f"{self._source.path}: this is no XML: {error}") from None
        assert self._root is not None
        return self._root

    def _still_open(self) -> str:
        if not self._open:
            return ""
        line = str(self._open[-1].place()[1]).partition(":")[0]
        return f"; {self._open[-1].described()} of line {line} is open"

    def _start(self, name: str, attributes: dict[str, Any]) -> None:
        parent = self._open[-1] if self._open else None
        line, column = self._expat.CurrentLineNumber, self._expat.CurrentColumnNumber + 1
        if len(self._open) >= _DEEPEST:
            raise InvalidFrontendLaunchFileError(f"{self._source.path}:{line}:{column}: <{name}> is nested too deeply")
        entity = Entity(name, attributes, source=self._source, line=line, column=column, parent=parent)
        if parent is None:
            self._root = entity
        else:
            parent.add(entity)
        self._open.append(entity)

    def _end(self, name: str) -> None:
        self._open.pop()

    def _text(self, text: str) -> None:
        if text.strip():
            launch_logging.get_logger("launch").warning(
                f"{self._source.path}:{self._expat.CurrentLineNumber}: the text {text.strip()[:40]!r} in "
                f"{self._open[-1].described()} has no effect; values stand in attributes"
            )
