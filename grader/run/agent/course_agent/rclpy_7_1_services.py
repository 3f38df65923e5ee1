"""The patches of requests and responses in rclpy 7.1, on clients and services; `rclpy_7_1.py` installs them."""

from __future__ import annotations

import copy
from typing import Any

from .executor_monitor import ExecutorMonitor
from .inbox import Kept, has_kept, kept
from .rclpy_7_1_waits import may_ask


def watch_services(monitor: ExecutorMonitor) -> None:
    """Patch requests and responses, on clients and services."""
    from rclpy.client import Client
    from rclpy.executors import Executor
    from rclpy.service import Service
    from rclpy.task import Future

    take_request, take_response = Executor._take_service, Executor._take_client
    respond = Service.send_response

    def watched_take_request(executor: Any, service: Any) -> Any:
        if has_kept(service):
            return take_request(executor, Kept(service, kept(service).popleft()))
        callback = take_request(executor, service)
        if _took(callback, "request_and_header"):
            monitor.count(monitor.taken, f"request {service.service_name}")
        return callback

    def watched_take_response(executor: Any, client: Any) -> Any:
        if has_kept(client):
            return take_response(executor, Kept(client, kept(client).popleft()))
        callback = take_response(executor, client)
        if _took(callback, "header_and_response"):
            monitor.count(monitor.taken, f"response {client.service_name}")
        return callback

    def watched_call_async(client: Any, request: Any) -> Any:
        if not isinstance(request, client.srv_type.Request):
            raise TypeError
        asked = copy.deepcopy(request)
        future = Future()
        future.add_done_callback(client.remove_pending_request)

        def send() -> None:
            with client._lock, client.handle:
                if not future.done():
                    sequence = client.handle.send_request(asked)
                    client._pending_requests[sequence] = future
            if client.service_is_ready():
                monitor.count(monitor.delivered, f"request {client.service_name}")

        monitor.hold(send, may_ask(client, client.service_is_ready))
        return future

    def watched_respond(service: Any, response: Any, header: Any) -> None:
        if not isinstance(response, service.srv_type.Response):
            raise TypeError

        def send() -> None:
            respond(service, response, header)
            monitor.count(monitor.delivered, f"response {service.service_name}")

        monitor.hold(send)

    Executor._take_service = watched_take_request
    Executor._take_client = watched_take_response
    Client.call_async = watched_call_async
    Service.send_response = watched_respond


def _took(callback: Any, pair: str) -> bool:
    """Return whether something was taken: a response to another client wakes a client, too, which takes nothing.

    `callback` is what the executor is going to run; its variable `pair` holds what was taken.
    """
    if callback is None:
        return False
    variables = variables_of(callback)
    return pair in variables and None not in variables[pair]


def variables_of(callback: Any) -> dict[str, Any]:
    """Return the variables of a closure."""
    cells = callback.__closure__ or ()
    return {name: cell.cell_contents for name, cell in zip(callback.__code__.co_freevars, cells, strict=False)}
