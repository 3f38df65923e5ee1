"""Completion at a shell's Tab with argcomplete, as ROS 2's own `ros2` does it: `ros2 topic echo /sc<Tab>`.

`eval "$(register-python-argcomplete ros2)"` sets it up in bash and zsh. At each Tab the shell runs `ros2` with the
variable `_ARGCOMPLETE`. Only the verb in question is imported; its arguments are completed by their names with live
topics, nodes, services, actions and parameters, packages, launch files and interfaces.

Source: https://kislyuk.github.io/argcomplete
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gz_course.sim.ros.ros2.command_files import COMMANDS, found, load
from gz_course.sim.ros.ros2.errors import CommandError

Given = Mapping[str, Any]
"""The values of the arguments before the cursor, by name."""


def complete(**options: Any) -> None:
    """Print the completions of the word at the cursor and end the process; `options` are those of argcomplete."""
    import argcomplete

    words = argcomplete.split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))[3]
    parser = argparse.ArgumentParser(prog="ros2")
    _add_verbs(parser, COMMANDS, words[int(os.environ["_ARGCOMPLETE"]) :])
    nothing = argcomplete.SuppressCompleter()
    argcomplete.autocomplete(parser, always_complete_options=False, default_completer=nothing, **options)


def _add_verbs(parser: argparse.ArgumentParser, folder: Path, words: list[str]) -> None:
    """Add the commands or verbs of a folder, with arguments only for the one named by the first of `words`."""
    known = found(folder)
    if words and words[0] not in known:
        return
    verbs = parser.add_subparsers()
    for name, path in known.items():
        verb = verbs.add_parser(name)
        if words[:1] != [name]:
            continue
        if path.is_dir():
            _add_verbs(verb, path, words[1:])
            continue
        load(path).add_arguments(verb)
        for action in verb._actions:
            if action.dest in _COMPLETERS:
                action.completer = _completer(_COMPLETERS[action.dest])  # type: ignore[attr-defined]


def _completer(names: Callable[[Given], Iterable[str]]) -> Callable[..., list[str]]:
    """Return a completer for argcomplete, which offers nothing if the preceding arguments are wrong."""

    def completer(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        try:
            return sorted(names(vars(parsed_args)))
        except CommandError:
            return []

    return completer


def _live(question: Callable[[Any], Iterable[str]]) -> list[str]:
    from gz_course.sim.ros.ros2.graph import Graph, destroy_ended

    try:
        with Graph(argparse.Namespace(spin_time=None, use_sim_time=False)) as graph:
            graph.settle()
            return list(question(graph))
    finally:
        destroy_ended()


def _types(name: str, names_and_types: str, kind: str) -> Callable[[Given], Iterable[str]]:
    """Return a function that lists the types of the live topic, service, ... `name`, or all interfaces of a kind."""

    def types(given: Given) -> Iterable[str]:
        from gz_course.sim.ros.ros2.interface import interface_names

        def question(graph: Any) -> Iterable[str]:
            return dict(getattr(graph, names_and_types)(hidden=True)).get(given[name], [])

        return (given.get(name) and _live(question)) or interface_names(kind)

    return types


def _parameters(given: Given) -> Iterable[str]:
    from gz_course.sim.ros.ros2.parameter import NodeParameters

    return _live(lambda graph: NodeParameters(graph, given["node_name"]).names())


def _packages(given: Given) -> Iterable[str]:
    from gz_course.sim.ros.ros2.packages import package_names

    return package_names()


def _licenses(given: Given) -> Iterable[str]:
    from gz_course.sim.ros.ros2.new_package.license_texts import KNOWN

    return KNOWN


def _executables(given: Given) -> Iterable[str]:
    from gz_course.sim.ros.ros2.packages import executables

    return (path.name for path in executables(given["package_name"]))


def _launch_files(given: Given) -> Iterable[str]:
    """Return the launch files of a package; after a path, the arguments of that launch file."""
    from gz_course.sim.ros.ros2.command.launch import launch_files_of
    from gz_course.sim.ros.ros2.packages import package_names

    package = given["package_name"]
    if Path(package).is_file():
        return _launch_arguments(given)
    return launch_files_of(package) if package in package_names() else ()


def _launch_arguments(given: Given) -> Iterable[str]:
    from gz_course.sim.ros.ros2.command.launch import launch_file, load

    path, _ = launch_file(argparse.Namespace(**{"launch_file_name": None, **given, "launch_arguments": []}))
    return (f"{argument.name}:=" for argument in load(path).get_launch_arguments())


def _interfaces(given: Given) -> Iterable[str]:
    from gz_course.sim.ros.ros2.interface import interface_names

    return interface_names()


def _values(given: Given) -> Iterable[str]:
    """Return a message, request or goal with default values in one line, for editing."""
    from gz_course.sim.ros.ros2.interface import action_class, message_class, service_class
    from gz_course.sim.ros.ros2.message_text import to_line

    if action := given.get("action_type"):
        return [to_line(action_class(action).Goal())]
    if service := given.get("service_type"):
        return [to_line(service_class(service).Request())]
    return [to_line(message_class(given["message_type"])())]


def _bags(given: Given) -> Iterable[str]:
    """Return the bags in the working directory: folders, and single files."""
    folders = (path.parent.name for path in Path().glob("*/metadata.yaml"))
    return (*folders, *(path.name for pattern in ("*.mcap", "*.db3", "*.zstd") for path in Path().glob(pattern)))


_COMPLETERS: Mapping[str, Callable[[Given], Iterable[str]]] = MappingProxyType(
    {
        "topic_name": lambda given: _live(lambda graph: (name for name, _ in graph.topics())),
        "topic_names": lambda given: _live(lambda graph: (name for name, _ in graph.topics())),
        "message_type": _types("topic_name", "topics", "msg"),
        "service_name": lambda given: _live(lambda graph: (name for name, _ in graph.services())),
        "service_type": _types("service_name", "services", "srv"),
        "action_name": lambda given: _live(lambda graph: (name for name, _ in graph.actions())),
        "action_type": _types("action_name", "actions", "action"),
        "node_name": lambda given: _live(lambda graph: graph.nodes()),
        "parameter_name": _parameters,
        "parameter_names": _parameters,
        "package_name": _packages,
        "dependencies": _packages,
        "license": _licenses,
        "executable_name": _executables,
        "launch_file_name": _launch_files,
        "launch_arguments": _launch_arguments,
        "type": _interfaces,
        "values": _values,
        "bag_path": _bags,
        "goal": _values,
    }
)
"""The function that returns the completions of an argument, by its name in any verb."""
