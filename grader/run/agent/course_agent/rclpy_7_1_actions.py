"""The patches of rclpy 7.1 that concern actions: goals, feedback, results and cancellations are counted and held.

An action is three services and two topics below `NAME/_action/`; they are counted like others (`executor_monitor.py`).
`import_hooks.py` calls `install` when `rclpy.action` is imported.

Source: the Python files of rclpy 7.1.6, https://github.com/ros2/rclpy/tree/jazzy/rclpy/rclpy/action
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any
from weakref import WeakValueDictionary

from .executor_monitor import ExecutorMonitor
from .inbox import has_kept, kept
from .patience import await_found
from .rclpy_7_1 import monitor as monitor_of_this_process
from .rclpy_7_1_waits import SERVICE_LOOK, may_ask, nudge
from .self_check import Reliance, misfits

RELIED_UPON: dict[str, Reliance] = {
    "rclpy.action.client:ActionClient.__init__": ("", "_node _action_name _action_type _client_handle"),
    "rclpy.action.client:ActionClient.take_data": (
        "self",
        "_is_goal_response_ready _is_cancel_response_ready _is_result_response_ready _is_feedback_ready "
        "_is_status_ready",
    ),
    "rclpy.action.client:ActionClient.send_goal_async": ("self goal feedback_callback goal_uuid", "send_goal_request"),
    "rclpy.action.client:ActionClient._cancel_goal_async": ("self goal_handle", "send_cancel_request"),
    "rclpy.action.client:ActionClient._get_result_async": ("self goal_handle", "send_result_request"),
    "rclpy.action.client:ActionClient.server_is_ready": ("self", ""),
    "rclpy.action.client:ActionClient.wait_for_server": ("self timeout_sec", "server_is_ready time sleep"),
    "rclpy.action.server:ActionServer.__init__": ("", "_node _handle"),
    "rclpy.action.server:ActionServer.take_data": (
        "self",
        "_is_goal_request_ready _is_cancel_request_ready _is_result_request_ready _is_goal_expired",
    ),
    "rclpy.action.server:ActionServer._execute_goal_request": ("", "send_goal_response publish_status"),
    "rclpy.action.server:ActionServer._execute_cancel_request": ("", "send_cancel_response"),
    "rclpy.action.server:ActionServer._send_result_response": ("", "send_result_response"),
    "rclpy.action.server:ServerGoalHandle.publish_feedback": ("", "publish_feedback"),
}
SERVICES = {"goal": "send_goal", "cancel": "cancel_goal", "result": "get_result"}
# What may be waiting for a client and for a server: the names of their flags.
FROM_SERVERS = ("goal_response", "cancel_response", "result_response", "feedback", "status")
CLIENTS = tuple(f"_is_{what}_ready" for what in FROM_SERVERS)
SERVERS = tuple(f"_is_{what}_ready" for what in ("goal_request", "cancel_request", "result_request"))


def install() -> None:
    """Start to watch actions. Raises ImportError if the imported rclpy is not the one expected."""
    from rclpy.action.client import ActionClient
    from rclpy.action.server import ActionServer

    if found := misfits(RELIED_UPON):
        raise ImportError(f"this rclpy cannot be kept in step: {found[0]}")
    monitor = monitor_of_this_process()
    _watch_clients(monitor)
    _watch_servers(monitor)
    for end in (ActionClient, ActionServer):  # they make endpoints, as in `rclpy_7_1.py`
        end.__init__ = monitor.threads.working(end.__init__)


def _name(end: Any) -> str:
    """Return the resolved name of the action of a client or server."""
    found: str | None = getattr(end, "course_name", None)
    if found is None:
        given = end._action_name if hasattr(end, "_action_name") else end.course_given_name
        resolve = end._node.resolve_service_name
        found = end.course_name = resolve(f"{given}/_action/send_goal").removesuffix("/_action/send_goal")
    return found


def _nudge(monitor: ExecutorMonitor, flags: tuple[str, ...], name: str) -> None:
    """Count the executors of this process as at work that have a client or a server of an action.

    `flags` tells which of the two. What was sent wakes these executors, and no others.
    """
    for node in monitor.nodes:
        if any(getattr(each, "course_flags", None) is flags and _name(each) == name for each in node.waitables):
            nudge(monitor, node.executor)


def _watch_takes(monitor: ExecutorMonitor, kind: Any, counted: Callable[[str], str]) -> None:
    """Patch what an end of an action takes: what was kept comes first. `counted(key)` is the name below `_action/`."""
    take_data = kind.take_data

    def watched_take_data(end: Any) -> Any:
        if has_kept(end):
            return kept(end).popleft()
        data = take_data(end)
        for key in data:
            if key != "expired":
                monitor.count(monitor.taken, _label(counted(key), _name(end)))
        return data

    def take_all(end: Any) -> None:
        """Keep all that has arrived, for an executor that does not look at the moment."""
        flags = {flag: getattr(end, flag) for flag in end.course_flags}
        expired = getattr(end, "_is_goal_expired", False)
        try:
            end._is_goal_expired = False
            while True:
                for flag in flags:
                    setattr(end, flag, True)
                data = take_data(end)
                if not data:
                    return
                for key, item in data.items():
                    monitor.count(monitor.taken, _label(counted(key), _name(end)))
                    kept(end).append({key: item})
        finally:
            for flag, before in flags.items():
                setattr(end, flag, before)
            end._is_goal_expired = expired

    kind.take_data = watched_take_data
    kind.course_take_all = take_all


def _label(what: str, name: str) -> str:
    """Return the counter's name for `KIND ENDING` of an action: that of a service's request or response, or a topic."""
    kind, _, ending = what.rpartition(" ")
    return f"{kind} {name}/_action/{ending}".strip()


def _watch_clients(monitor: ExecutorMonitor) -> None:
    from rclpy.action.client import ActionClient
    from rclpy.task import Future

    ActionClient.course_flags = CLIENTS
    _watch_takes(monitor, ActionClient, lambda key: f"response {SERVICES[key]}" if key in SERVICES else key)

    def held(method: Any, service: str, fits: Callable[[Any, Any], bool]) -> Any:
        def call(client: Any, asked: Any, *arguments: Any, **options: Any) -> Any:
            if not fits(client, asked):
                return method(client, asked, *arguments, **options)  # raises
            asked = copy.deepcopy(asked) if service == "send_goal" else asked
            answered = Future()
            client.add_future(answered)
            answered.add_done_callback(lambda future: client.remove_future(future))

            def send() -> None:
                inner = method(client, asked, *arguments, **options)
                if client.server_is_ready():
                    monitor.count(monitor.delivered, f"request {_name(client)}/_action/{service}")
                inner.add_done_callback(lambda future: answered.set_result(future.result()))
                _nudge(monitor, SERVERS, _name(client))

            monitor.hold(send, may_ask(client, client.server_is_ready))
            return answered

        return call

    wait = ActionClient.wait_for_server

    def patient_wait(client: Any, timeout_sec: float | None = None) -> bool:
        await_found(monitor.threads, client._node.context.ok, client.server_is_ready, SERVICE_LOOK)
        return bool(wait(client, timeout_sec))

    def is_goal(client: Any, goal: Any) -> bool:
        return isinstance(goal, client._action_type.Goal)

    def is_handle(client: Any, handle: Any) -> bool:
        return hasattr(handle, "goal_id")

    ActionClient.send_goal_async = held(ActionClient.send_goal_async, "send_goal", is_goal)
    ActionClient._cancel_goal_async = held(ActionClient._cancel_goal_async, "cancel_goal", is_handle)
    ActionClient._get_result_async = held(ActionClient._get_result_async, "get_result", is_handle)
    ActionClient.wait_for_server = patient_wait


def _watch_servers(monitor: ExecutorMonitor) -> None:
    from rclpy.action.server import ActionServer
    from rclpy.impl.implementation_singleton import rclpy_implementation as rcl

    servers: WeakValueDictionary[int, Any] = WeakValueDictionary()  # by the id of the handle
    begin, handle_class = ActionServer.__init__, rcl.ActionServer
    ActionServer.course_flags = SERVERS
    _watch_takes(monitor, ActionServer, lambda key: f"request {SERVICES[key]}")

    def watched_begin(server: Any, node: Any, action_type: Any, action_name: str, *more: Any, **options: Any) -> None:
        server.course_given_name = action_name
        begin(server, node, action_type, action_name, *more, **options)
        servers[id(server._handle)] = server

    def respond(service: str, method: Any) -> Any:
        def call(handle: Any, header: Any, response: Any) -> None:
            name = _name(servers[id(handle)])

            def send() -> None:
                method(handle, header, response)
                monitor.count(monitor.delivered, f"response {name}/_action/{service}")
                _nudge(monitor, CLIENTS, name)

            monitor.hold(send)

        return call

    def publish(topic: str, method: Any) -> Any:
        def call(handle: Any, *message: Any) -> None:
            server = servers[id(handle)]
            name = f"{_name(server)}/_action/{topic}"
            sent = copy.deepcopy(message)  # the caller may change it later

            def send() -> None:
                readers = server._node.count_subscribers(name)
                method(handle, *sent)
                monitor.count(monitor.delivered, name, readers)
                _nudge(monitor, CLIENTS, _name(server))

            monitor.hold(send)

        return call

    ActionServer.__init__ = watched_begin
    for what, service in SERVICES.items():
        setattr(handle_class, f"send_{what}_response", respond(service, getattr(handle_class, f"send_{what}_response")))
    for topic in ("feedback", "status"):
        setattr(handle_class, f"publish_{topic}", publish(topic, getattr(handle_class, f"publish_{topic}")))
