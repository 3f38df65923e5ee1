"""Makes launch descriptions of launch files in XML and YAML.

Source: ros2/launch, launch/launch/frontend/parser.py
"""

from __future__ import annotations

import contextlib
import importlib
import os
from typing import Any, ClassVar, TextIO

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.errors import written_at
from gz_course.sim.ros.launch.frontend.entity import Entity, EntityError, LaunchText
from gz_course.sim.ros.launch.frontend.expose import action_parse_methods
from gz_course.sim.ros.launch.frontend.extensions import EXTENSIONS, load_foreign_extensions
from gz_course.sim.ros.launch.frontend.parse_substitution import (
    parse_if_substitutions,
    parse_substitution,
    replace_escaped_characters,
)
from gz_course.sim.ros.launch.invalid_launch_file_error import InvalidLaunchFileError
from gz_course.sim.ros.launch.substitution import Substitution

_SIM = __name__.partition(".launch.")[0]
_FORMATS = {"xml": "launch_xml", "yaml": "launch_yaml", "yml": "launch_yaml"}
# What ROS 1 calls differently, and what people try: name -> what to write.
_OTHER_NAMES = {
    "param": "set_parameter",
    "rosparam": "set_parameters_from_file",
    "remap": "set_remap",
    "env": "set_env",
    "test": "node",
    "process": "executable",
    "declare_launch_argument": "arg",
    "set": "let",
    "log_info": "log",
    "composable_node_container": "node_container",
}


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A launch file in XML or YAML is not valid; the text is one line."""

    def __init__(self, sentence: str) -> None:
        super().__init__(" ".join(sentence.split()))


class Parser:
    """Makes actions of entities; subclasses override `load`."""

    extensions_loaded: ClassVar[bool] = False

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Load the packages that bring actions and substitutions."""
        if not Parser.extensions_loaded:
            Parser.extensions_loaded = True
            for name in EXTENSIONS:
                importlib.import_module(f"{_SIM}.{name}")

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the extensions of file names of all formats."""
        return list(_FORMATS)

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        return extension in _FORMATS

    @classmethod
    def get_parser_from_extension(cls, extension: str) -> type[Parser]:
        """Return the parser for files with this extension. Raises RuntimeError if there is none."""
        if extension not in _FORMATS:
            raise RuntimeError(f"there is no format of launch files '{extension}'{did_you_mean(extension, _FORMATS)}")
        parser: type[Parser] = importlib.import_module(f"{_SIM}.{_FORMATS[extension]}").Parser
        return parser

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the root of a file, in the format of its name or its first character, and the parser for it."""
        name = str(getattr(file, "name", file))
        extension = name.rpartition(".")[2]
        if extension not in _FORMATS:
            text = file.read() if hasattr(file, "read") else read_text(file)
            extension = "xml" if text.lstrip().startswith("<") else "yaml"
            return cls.get_parser_from_extension(extension).load_text(text, name)
        return cls.get_parser_from_extension(extension).load(file)

    @classmethod
    def load_text(cls, text: str, path: str) -> tuple[Entity, Parser]:
        """Return the root of a text, and the parser for it; `path` is named in errors."""
        raise NotImplementedError

    def parse_action(self, entity: Entity) -> Action:
        """Return the action of an entity. Raises InvalidLaunchFileError, with the place of the mistake."""
        self.load_launch_extensions()
        name = entity.type_name
        method = action_parse_methods.get(name)
        if method is None:
            load_foreign_extensions()
            method = action_parse_methods.get(name)
        if method is None:
            meant = _OTHER_NAMES.get(name)
            hint = f"; write {meant}" if meant else did_you_mean(name, action_parse_methods, listing="there are")
            raise EntityError(entity, f"there is no action {entity.described()}{hint}")
        entity.source.read = None
        with _located(entity), written_at(entity.place()):
            kind, options = method(entity, self)
            entity.assert_entity_completely_parsed()
            entity.source.read = None
            action: Action = kind(**options)
        return action

    def parse_description(self, entity: Entity) -> Any:
        """Return the launch description of the root of a file. Raises InvalidLaunchFileError."""
        from gz_course.sim.ros.launch.launch_description import LaunchDescription

        if entity.type_name != "launch":
            raise EntityError(entity, f"a launch file begins with `launch`, this one with {entity.described()}")
        self.load_launch_extensions()
        with _located(entity), written_at(entity.place()):
            return LaunchDescription([self.parse_action(child) for child in entity.children])

    def parse_substitution(self, value: str) -> list[Substitution]:
        """Return the substitutions that a text holds."""
        return parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        """Return a value, whose texts become substitutions if they hold any."""
        return parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        return replace_escaped_characters(value)


def read_text(file: Any) -> str:
    """Return the text of a file. Raises InvalidFrontendLaunchFileError."""
    try:
        with open(file, encoding="utf-8") as opened:  # noqa: PTH123
            return opened.read()
    except OSError as error:
        raise InvalidFrontendLaunchFileError(f"the launch file '{file}' cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, ValueError):
        raise InvalidFrontendLaunchFileError(f"{file}: this is no text in UTF-8") from None


@contextlib.contextmanager
def _located(entity: Entity) -> Any:
    """Turn errors of parsing into one sentence with the place of the entity, or of the attribute just read."""
    try:
        yield
    except InvalidLaunchFileError:
        raise
    except RecursionError:
        raise EntityError(entity, "the elements are nested too deeply") from None
    except Exception as error:
        where, attribute = entity.source.read or (entity, None)
        what = f"{where.described()}" if attribute is None else f"'{attribute}' of {where.described()}"
        raise EntityError(where, f"{what}: {one_line(error)}", attribute) from error


def one_line(error: BaseException) -> str:
    text = " ".join(str(error.args[0] if isinstance(error, KeyError) and error.args else error).split())
    return text or type(error).__name__


def source_of(file: Any) -> LaunchText:
    """Return path and text of a file that is a path or open."""
    if hasattr(file, "read"):
        return LaunchText(str(getattr(file, "name", "<text>")), file.read())
    return LaunchText(os.fspath(file), read_text(file))
