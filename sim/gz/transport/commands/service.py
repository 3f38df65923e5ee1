"""Look at services and call them: `gz service -l`, `gz service -s /world/default/control ...`.

Output and exit codes are those of the tool of Gazebo Harmonic: a call that fails or that nobody answers ends with 0,
too. If no provider answered, the nearest service or the right types are named.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/cmd/service_main.cc
"""

from __future__ import annotations

import argparse
import sys

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser, whole_number
from gz_course.sim.gz.msgs import canonical_name, message_class
from gz_course.sim.gz.transport.node import Node
from gz_course.sim.gz.transport.service import EMPTY_TYPE

_TIMEOUT_MS = 1000
_FORTRESS = "ignition.msgs."


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-s", "--service", metavar="NAME", help="name of a service")
    parser.add_argument("--reqtype", metavar="TYPE", help="type of the request; without it there are no arguments")
    parser.add_argument("--reptype", metavar="TYPE", help="type of the response; without it none is waited for")
    parser.add_argument(
        "--timeout", type=whole_number, metavar="MS", default=_TIMEOUT_MS, help="wait at most MS milliseconds (1000)"
    )
    parser.add_argument("-l", "--list", action="store_true", help="the names of all services")
    parser.add_argument("-i", "--info", action="store_true", help="providers of a service, and its types")
    parser.add_argument(
        "-r", "--req", nargs="?", const="", metavar="TEXT", help="call the service with a request: 'pause: true'"
    )
    parser.commands("--list", "--info", "--req")
    parser.needs("--info", "--service")
    parser.needs("--req", "--service")


def run(values: argparse.Namespace) -> int:
    """Run `gz service`; return the exit code. Raises ValueError for invalid names, types and texts."""
    with Node() as node:
        if values.service is not None:
            node.options.qualified(values.service, "service")
        if values.list:
            for service in node.service_list():
                print(service)
            return 0
        if values.info:
            return _info(node, values.service)
        return _call(node, values)


def _info(node: Node, service: str) -> int:
    providers = node.service_info(service)
    if providers:
        print("Service providers [Address, Request Message Type, Response Message Type]:")
        for each in providers:
            print(f"  {each.addr}, {each.req_type_name}, {each.rep_type_name}")
        return 0
    print(f"No service providers on service [{service}]")
    _report(f"there is no service [{service}]{_nearest_service(node, service)}")
    return 0


def _call(node: Node, values: argparse.Namespace) -> int:
    from gz_course.sim.gz.msgs.text import from_text, to_text

    request_type, response_type = values.reqtype or EMPTY_TYPE, values.reptype or EMPTY_TYPE
    request = from_text(values.req, message_class(request_type))
    response = message_class(response_type)()
    outcome = node.call_raw(
        values.service,
        request.SerializeToString(),
        _on_wire(request_type),
        _on_wire(response_type),
        values.timeout,
    )
    if not outcome.executed:
        why = _why_not(node, values.service, request_type, response_type, values.timeout)
        print(f"Service call timed out: {why}", file=sys.stderr)
        return 0
    if not outcome.result:
        print("Service call failed")
        return 0
    if canonical_name(response_type) != EMPTY_TYPE:
        response.ParseFromString(outcome.response)
        sys.stdout.write(f"{to_text(response)}\n")
    return 0


def _on_wire(type_name: str) -> str:
    return type_name if type_name.startswith(_FORTRESS) else str(message_class(type_name).DESCRIPTOR.full_name)


def _why_not(node: Node, service: str, request_type: str, response_type: str, timeout_ms: int) -> str:
    providers = node.service_info(service)
    if not providers:
        return f"there is no service [{service}]{_nearest_service(node, service)}"
    wanted = (canonical_name(request_type), canonical_name(response_type))
    offered = [(canonical_name(each.req_type_name), canonical_name(each.rep_type_name)) for each in providers]
    if wanted not in offered:
        return (
            f"[{service}] takes {offered[0][0]} and answers with {offered[0][1]}; "
            f"the call was for {wanted[0]} and {wanted[1]}."
        )
    return f"[{service}] did not answer within {timeout_ms} ms; a longer --timeout may help."


def _nearest_service(node: Node, service: str) -> str:
    return did_you_mean(service, node.service_list()) or "; see gz service -l"


def _report(sentence: str) -> None:
    print(f"gz service: {sentence}", file=sys.stderr)
