"""Completes what is typed at a shell: `ros2 topic echo /sc<Tab>`.

`ros2 --print-completion bash` (or zsh) prints a script for the shell. At each Tab it runs `ros2 --complete` with the
words before the cursor; that prints one candidate a line: commands, verbs and options from the same files
`command_line` runs, and the names of live topics, nodes, services and parameters, of packages and of interfaces.
"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gz_course.sim.ros2.errors import CommandError

PRINT, COMPLETE = "--print-completion", "--complete"
HELP = (
    "Completion of commands, names and types at a Tab:",
    f'  bash: eval "$(ros2 {PRINT} bash)", in ~/.bashrc to keep it; zsh: the same with zsh, behind compinit',
)

_BASH = f"""\
_ros2() {{
    local IFS=$'\\n'
    COMPREPLY=( $(ros2 {COMPLETE} "${{COMP_WORDS[@]:1:COMP_CWORD}}" 2>/dev/null) )
    [[ ${{COMPREPLY[0]-}} == *:= ]] && compopt -o nospace
}}
complete -o default -F _ros2 ros2
"""
_ZSH = f"""\
_ros2() {{
    local -a found
    found=( "${{(@f)$(ros2 {COMPLETE} "${{(@)words[2,CURRENT]}}" 2>/dev/null)}}" )
    compadd -Q -- ${{found:#}}
}}
compdef _ros2 ros2
"""
_SCRIPTS: Mapping[str, str] = MappingProxyType({"bash": _BASH, "zsh": _ZSH})


def print_script(arguments: list[str]) -> int:
    """Print the script for the shell that is named; CommandError for one there is none for."""
    if len(arguments) != 1 or arguments[0] not in _SCRIPTS:
        raise CommandError(f"{PRINT} takes the name of the shell: {' or '.join(_SCRIPTS)}")
    print(_SCRIPTS[arguments[0]], end="")
    return 0


def print_candidates(words: list[str]) -> int:
    """Print what the last of these words could become, one candidate a line; nothing where nothing is known."""
    try:
        for candidate in candidates(words or [""]):
            print(candidate)
    except (CommandError, SystemExit):
        pass
    return 0


def candidates(words: list[str]) -> list[str]:
    """What the last word can become, sorted; the words before it are the command, its verb and its arguments."""
    from gz_course.sim.ros2.command_line import COMMANDS, found, load

    *before, start = words
    folder = COMMANDS
    while True:
        known = found(folder)
        if not before:
            extra = ["--help"] + ([PRINT] if folder == COMMANDS else [])
            return _beginning([*known, *(extra if start.startswith("-") else [])], start)
        word, *before = before
        if word == PRINT:
            return _beginning(_SCRIPTS, start)
        if word not in known:
            return []
        if not known[word].is_dir():
            _, parser = load(known[word], f"ros2 {word}")
            return _beginning(_for_verb(parser, before, start), start)
        folder = known[word]


def _beginning(names: Iterable[str], start: str) -> list[str]:
    return sorted({name for name in names if name.startswith(start)})


def _for_verb(parser: argparse.ArgumentParser, before: list[str], start: str) -> Iterable[str]:
    """Candidates of one verb: its options, the choices of an option, or the names its next argument stands for."""
    options = parser._option_string_actions
    given: dict[str, str] = {}
    positional = [action for action in parser._actions if not action.option_strings]
    awaited: argparse.Action | None = None
    for word in before:
        if awaited is not None:
            awaited = None
        elif word in options:
            awaited = options[word] if options[word].nargs != 0 else None
        elif positional:
            given[positional[0].dest] = word
            if positional[0].nargs not in ("+", "*", argparse.REMAINDER):
                positional.pop(0)
    if awaited is not None:
        return map(str, awaited.choices or ())
    if start.startswith("-"):
        return options
    if not positional:
        return ()
    if positional[0].choices:
        return map(str, positional[0].choices)
    complete = _COMPLETERS.get(positional[0].dest)
    return complete(given) if complete else ()


Given = Mapping[str, str]
"""The arguments before: name -> word."""


def _look(question: Callable[[Any], Iterable[str]]) -> list[str]:
    """Ask the live graph."""
    from gz_course.sim.ros2.graph import Graph

    with Graph(argparse.Namespace(spin_time=None, use_sim_time=False)) as graph:
        graph.settle()
        return list(question(graph))


def _topics(given: Given) -> Iterable[str]:
    return _look(lambda graph: (name for name, _ in graph.topics()))


def _message_types(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.interface import interface_names

    topic = given.get("topic_name", "")
    return (topic and _look(lambda graph: dict(graph.topics(hidden=True)).get(topic, []))) or interface_names("msg")


def _services(given: Given) -> Iterable[str]:
    return _look(lambda graph: (name for name, _ in graph.services()))


def _service_types(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.interface import interface_names

    service = given.get("service_name", "")
    live = service and _look(lambda graph: dict(graph.services(hidden=True)).get(service, []))
    return live or interface_names("srv")


def _nodes(given: Given) -> Iterable[str]:
    return _look(lambda graph: graph.nodes())


def _parameters(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.parameter import NodeParameters

    return _look(lambda graph: NodeParameters(graph, given["node_name"]).names())


def _packages(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.packages import package_names

    return package_names()


def _executables(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.packages import executables

    return (path.name for path in executables(given["package_name"]))


def _launch_files(given: Given) -> Iterable[str]:
    """The launch files of a package; after a path, the arguments of that launch file."""
    from gz_course.sim.ros2.command.launch import launch_files_of
    from gz_course.sim.ros2.packages import package_names

    package = given["package_name"]
    if Path(package).is_file():
        return _launch_arguments(given)
    return launch_files_of(package) if package in package_names() else ()


def _launch_arguments(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.command.launch import launch_file, load

    named: dict[str, Any] = {"launch_file_name": None, **given, "launch_arguments": []}
    path, _ = launch_file(argparse.Namespace(**named))
    return (f"{argument.name}:=" for argument in load(path).get_launch_arguments())


def _interfaces(given: Given) -> Iterable[str]:
    from gz_course.sim.ros2.interface import interface_names

    return interface_names()


def _values(given: Given) -> Iterable[str]:
    """A message with default values in one line, quoted for the shell, to be edited."""
    from gz_course.sim.ros2.interface import message_class, service_class
    from gz_course.sim.ros2.message_text import to_line

    service = given.get("service_type")
    message = service_class(service).Request() if service else message_class(given["message_type"])()
    return [shlex.quote(to_line(message))]


_COMPLETERS: Mapping[str, Callable[[Given], Iterable[str]]] = MappingProxyType(
    {
        "topic_name": _topics,
        "message_type": _message_types,
        "service_name": _services,
        "service_type": _service_types,
        "node_name": _nodes,
        "parameter_name": _parameters,
        "parameter_names": _parameters,
        "package_name": _packages,
        "executable_name": _executables,
        "launch_file_name": _launch_files,
        "launch_arguments": _launch_arguments,
        "type": _interfaces,
        "values": _values,
    }
)
"""Name of an argument, in whichever verb -> what it can be."""
