"""The action that starts a ROS node: an ExecuteProcess with this command:

    <executable> <arguments> [--ros-args <ros_arguments>] --ros-args [-r __node:=<name>] [-r __ns:=<namespace>]
        <parameters of the scope> <its own parameters> [-r <from>:=<to> ...]

Source: ros2/launch_ros, launch_ros/launch_ros/actions/node.py
Source: https://design.ros2.org/articles/ros_command_line_arguments.html
"""

from __future__ import annotations

import contextlib
import os
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.actions.execute_process import ExecuteProcess
from gz_course.sim.ros.launch.frontend.command_words import command_words
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.launch_ros.actions.push_ros_namespace import NAMESPACE
from gz_course.sim.ros.launch_ros.actions.set_parameter import PARAMETERS
from gz_course.sim.ros.launch_ros.actions.set_remap import REMAPS
from gz_course.sim.ros.launch_ros.nested_parameters import parse_node_options
from gz_course.sim.ros.launch_ros.node_name import check_namespace, check_node_name, joined
from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter, ParameterFile, write_parameter_file
from gz_course.sim.ros.launch_ros.parameter_values import (
    ParameterTypeError,
    as_argument,
    as_file,
    check_value,
    flattened,
)
from gz_course.sim.ros.launch_ros.substitutions import ExecutableInPackage

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser

# Attributes in XML and YAML -> arguments.
_ATTRIBUTES = {
    "exec": "executable",
    "pkg": "package",
    "name": "name",
    "namespace": "namespace",
    "exec_name": "exec_name",
}
_NODE_NAMES = "launch_ros_node_names"
_LOG = launch_logging.get_logger("launch_ros.actions.node")


@expose_action("node")
class Node(ExecuteProcess):
    """Starts `executable` of `package`, or without a package the one on PATH.

    `parameters` is a list of dicts, parameter files (paths), Parameter and ParameterFile; later ones take precedence.
    `remappings` are pairs of names. `exec_name` is used in its label. Other arguments are those of ExecuteProcess.
    """

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        for old in kwargs:
            if old in ("node_name", "node_namespace", "node_executable"):
                raise TypeError(f"Node has no argument '{old}' any more; did you mean '{old.removeprefix('node_')}'?")
        program = executable if package is None else ExecutableInPackage(executable, package)
        super().__init__(cmd=[program, *_listed("arguments", arguments)], name=exec_name, **kwargs)
        self.node_package = None if package is None else normalize_to_list_of_substitutions(package)
        self.node_executable = normalize_to_list_of_substitutions(executable)
        self.__name = None if name is None else normalize_to_list_of_substitutions(name)
        self.__namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self.__parameters = [_as_parameter(item) for item in _listed("parameters", parameters)]
        self.__remappings = [_as_remapping(pair) for pair in remappings or ()]
        self.__ros_arguments = [
            normalize_to_list_of_substitutions(word) for word in _listed("ros_arguments", ros_arguments)
        ]
        self.__made_files: list[Path] = []
        self.__expanded_name: str | None = None
        self.expanded_node_namespace: str | None = None
        self.expanded_remapping_rules: list[tuple[str, str]] | None = None

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: Iterable[str] = ()) -> tuple[Any, dict[str, Any]]:
        """Read `<node pkg= exec= ...>`, which can hold `<param>`, `<remap from= to=/>` and `<env name= value=/>`."""
        _, options = super().parse(entity, parser, (*ignore, "cmd", "name"))
        for name, option in _ATTRIBUTES.items():
            needed = name == "exec"
            value = None if name in ignore else entity.get_attr(name, optional=not needed)
            if value is not None:
                options[option] = parser.parse_substitution(value)
        for name, option in (("args", "arguments"), ("ros_args", "ros_arguments")):
            words = entity.get_attr(name, optional=True)
            if words is not None:
                options[option] = command_words(words, parser)
        return cls, options | parse_node_options(entity, parser)

    @property
    def node_name(self) -> str | None:
        """Return namespace and name after execution; a part that only the node's code defines is in angle brackets."""
        namespace = self.expanded_node_namespace or "<node_namespace_unspecified>"
        return f"{namespace.rstrip('/')}/{self.__expanded_name or '<node_name_unspecified>'}"

    def is_node_name_fully_specified(self) -> bool:
        return self.__expanded_name is not None and self.expanded_node_namespace is not None

    def _described_words(self) -> list[str]:
        return [*super()._described_words(), "'--ros-args'"]

    def prepare(self, context: LaunchContext) -> None:
        """Build the command. Raises LaunchError for invalid names, packages and values."""
        configurations = context.launch_configurations
        self._expand_names(context)
        words = []
        if self.__ros_arguments:
            words += ["--ros-args", *[perform_substitutions(context, word) for word in self.__ros_arguments]]
        words.append("--ros-args")
        if self.__expanded_name is not None:
            words += ["-r", f"__node:={self.__expanded_name}"]
        if self.expanded_node_namespace is not None:
            words += ["-r", f"__ns:={self.expanded_node_namespace}"]
        for of_scope in configurations.get(PARAMETERS, ()):
            if isinstance(of_scope, tuple):
                words += ["-p", f"{of_scope[0]}:={as_argument(of_scope[1])}"]
            else:
                words += _file_words(of_scope)
        for parameter in self.__parameters:
            words += self._parameter_words(parameter, context)
        self.expanded_remapping_rules = [
            *configurations.get(REMAPS, ()),
            *[(perform_substitutions(context, a), perform_substitutions(context, b)) for a, b in self.__remappings],
        ]
        for source, target in self.expanded_remapping_rules:
            words += ["-r", f"{source}:={target}"]
        self.process_description.prepare(context, self, words)
        self._warn_of_equal_names(context)

    def cleanup(self) -> None:
        for path in self.__made_files:
            with contextlib.suppress(FileNotFoundError):
                path.unlink()
        for parameter in self.__parameters:
            if isinstance(parameter, ParameterFile):
                parameter.cleanup()

    def _expand_names(self, context: LaunchContext) -> None:
        if self.__name is not None:
            name = perform_substitutions(context, self.__name)
            if name:
                check_node_name(name)
                self.__expanded_name = name
        namespace = None if self.__namespace is None else perform_substitutions(context, self.__namespace)
        self.expanded_node_namespace = joined(context.launch_configurations.get(NAMESPACE), namespace)
        if self.expanded_node_namespace is not None:
            check_namespace(self.expanded_node_namespace)

    def _parameter_words(self, parameter: Any, context: LaunchContext) -> list[str]:
        if isinstance(parameter, ParameterFile):
            return _file_words(str(parameter.evaluate(context)))
        if isinstance(parameter, Parameter):
            name, value = parameter.evaluate(context)
            return ["-p", f"{name}:={as_argument(value)}"]
        node = "/**"
        if self.is_node_name_fully_specified():
            node = f"{(self.expanded_node_namespace or '').rstrip('/')}/{self.__expanded_name}"
        values = flattened(context, parameter)
        if not values:
            return []
        path = write_parameter_file(as_file(node, values))
        self.__made_files.append(path)
        return ["--params-file", str(path)]

    def _warn_of_equal_names(self, context: LaunchContext) -> None:
        if not self.is_node_name_fully_specified():
            return
        names: Counter[str] = context.get_locals_as_dict().get(_NODE_NAMES, Counter())
        context.extend_globals({_NODE_NAMES: names})
        name = str(self.node_name)
        names[name] += 1
        if names[name] > 1:
            _LOG.warning(
                f"there are now at least {names[name]} nodes with the name {name} in this launch; ROS cannot tell them "
                "apart, give each its own name or namespace"
            )


def _file_words(path: str) -> list[str]:
    if not os.path.isfile(path):  # noqa: PTH113
        _LOG.warning(f"Parameter file path is not a file: {path}")
        return []
    return ["--params-file", path]


def _listed(what: str, items: Any) -> list[Any]:
    if items is None:
        return []
    if isinstance(items, str | Substitution | Mapping | ParameterFile | Parameter) or not isinstance(items, Iterable):
        raise TypeError(f"{what} must be a list; write {what}=[{items!r}]")
    return list(items)


def _as_parameter(item: Any) -> Any:
    if isinstance(item, ParameterFile | Parameter):
        return item
    if isinstance(item, Mapping):
        for name, value in item.items():
            if not isinstance(name, str | Substitution | tuple):
                raise ParameterTypeError(f"the parameter name {name!r} is of type {type(name).__name__}, not text")
            check_value(name if isinstance(name, str) else "...", value)
        return item
    if isinstance(item, str | os.PathLike | Substitution | list | tuple):
        return ParameterFile(item)
    raise ParameterTypeError(
        f"parameters holds {item!r} of type {type(item).__name__}; a dict, the path of a parameter file, Parameter or "
        "ParameterFile is expected"
    )


def _as_remapping(pair: Any) -> tuple[list[Substitution], list[Substitution]]:
    if not isinstance(pair, tuple | list) or len(pair) != 2:
        raise TypeError(f'remappings holds {pair!r}; pairs are expected: remappings=[("/from", "/to")]')
    return normalize_to_list_of_substitutions(pair[0]), normalize_to_list_of_substitutions(pair[1])
