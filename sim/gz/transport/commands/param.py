"""List, read and set parameters of a registry: `gz param -r /world/default -l`.

A registry is a set of services below its name: `list_parameters`, `get_parameter` and `set_parameter`. A failure is one
line on stderr and exit code 1, not Gazebo's 0.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/parameters/src/cmd/ParamCommandAPI.cc
"""

from __future__ import annotations

import argparse
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser
from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.transport.node import Node

_TIMEOUT_MS = 5000
_LIST = "list_parameters"
_RULE = 48 * "-"


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-r", "--registry", metavar="NAME", help="the registry, e.g. /world/default")
    parser.add_argument("-l", "--list", action="store_true", help="the names and types of all parameters")
    parser.add_argument("-g", "--get", action="store_true", help="print a parameter")
    parser.add_argument("-s", "--set", action="store_true", help="set a parameter")
    parser.add_argument("-n", "--name", metavar="NAME", help="the parameter")
    parser.add_argument("-t", "--type", metavar="TYPE", help="its type, e.g. gz.msgs.Double")
    parser.add_argument("-m", "--value", metavar="TEXT", help="its value: 'data: 0.5'")
    parser.commands("--list", "--get", "--set")
    parser.needs("--list", "--registry")
    parser.needs("--get", "--registry", "--name")
    parser.needs("--set", "--registry", "--name", "--type", "--value")


def run(values: argparse.Namespace) -> int:
    """Run `gz param`; return the exit code. Raises ValueError if there is no such registry, parameter or type."""
    with Node() as node:
        registry = values.registry.rstrip("/")
        node.options.qualified(f"{registry}/{_LIST}", "service")
        if values.list:
            return _list(node, registry)
        if values.get:
            return _get(node, registry, values.name)
        return _set(node, registry, values)


def _ask(node: Node, registry: str, service: str, request: Any, response_type: str) -> tuple[bool, Any]:
    """Call a service of a registry; return whether it succeeded. Raises ValueError if nobody answers."""
    response = message_class(response_type)()
    outcome = node.call_raw(
        f"{registry}/{service}", request.SerializeToString(), request.DESCRIPTOR.full_name, response_type, _TIMEOUT_MS
    )
    if not outcome.executed:
        known = [name.removesuffix(f"/{_LIST}") for name in node.service_list() if name.endswith(f"/{_LIST}")]
        raise ValueError(f"there is no registry [{registry}]{did_you_mean(registry, known, listing='registries are')}")
    response.ParseFromString(outcome.response)
    return outcome.result, response


def _list(node: Node, registry: str) -> int:
    print(f"\nListing parameters, registry namespace [{registry}]...\n")
    declared = _declared(node, registry)
    if not declared:
        print("No parameters available")
    for name, kind in declared.items():
        print(f"{name}            [{kind}]")
    return 0


def _declared(node: Node, registry: str) -> dict[str, str]:
    done, response = _ask(node, registry, _LIST, message_class("gz.msgs.Empty")(), "gz.msgs.ParameterDeclarations")
    return {each.name: each.type for each in response.parameter_declarations} if done else {}


def _get(node: Node, registry: str, name: str) -> int:
    from gz_course.sim.gz.msgs.text import to_text

    print(f"\nGetting parameter [{name}] for registry namespace [{registry}]...")
    request = message_class("gz.msgs.ParameterName")(name=name)
    done, response = _ask(node, registry, "get_parameter", request, "gz.msgs.ParameterValue")
    if not done:
        raise ValueError(_unknown(node, registry, name))
    kind = response.data.TypeName()
    message = message_class(kind)()
    message.ParseFromString(response.data.value)
    print(f"Parameter type [{kind}]\n\n{_RULE}\n{to_text(message)}{_RULE}")
    return 0


def _set(node: Node, registry: str, values: argparse.Namespace) -> int:
    from gz_course.sim.gz.msgs.text import from_text

    print(f"\nSetting parameter [{values.name}] for registry namespace [{registry}]...")
    request: Any = message_class("gz.msgs.Parameter")(name=values.name)
    request.value.Pack(from_text(values.value, message_class(values.type)))
    done, response = _ask(node, registry, "set_parameter", request, "gz.msgs.ParameterError")
    outcome = response.Type.Name(response.data) if response.data in response.Type.values() else str(response.data)
    if done and outcome == "SUCCESS":
        print("Parameter successfully set!")
        return 0
    if outcome == "NOT_DECLARED":
        raise ValueError(_unknown(node, registry, values.name))
    kind = _declared(node, registry).get(values.name, "another type")
    raise ValueError(f"parameter [{values.name}] was not set ({outcome}): it is a {kind}, and {values.type} was given")


def _unknown(node: Node, registry: str, name: str) -> str:
    known = _declared(node, registry)
    hint = did_you_mean(name, known) or ("" if known else "; it has no parameters")
    return f"registry [{registry}] has no parameter [{name}]{hint}"
