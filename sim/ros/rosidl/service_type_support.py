"""The type support of services and actions: which messages they consist of, and how an event of a service is made.

Source: rosidl_runtime_c 4.6 (`service_type_support_struct.h`, `action_type_support_struct.h`)
"""

from __future__ import annotations

import ctypes as c
import logging
from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.rosidl.c_structs import (
    ActionTypeSupport,
    ServiceCallbacks,
    ServiceEventInfo,
    ServiceMembers,
    ServiceTypeSupport,
    address,
    keep,
    pointer_in,
)
from gz_course.sim.ros.rosidl.described_type import DescribedType
from gz_course.sim.ros.rosidl.introspection import IDENTIFIER as INTROSPECTION
from gz_course.sim.ros.rosidl.message_type_support import IDENTIFIER, MessageSupport, destroy_event, message_at

_log = logging.getLogger("rosidl")
_Handle: Callable[..., Any] = c.PYFUNCTYPE(c.c_void_p, c.c_void_p, c.c_char_p)
_CreateEvent: Callable[..., Any] = c.PYFUNCTYPE(
    c.c_void_p, c.POINTER(ServiceEventInfo), c.c_void_p, c.c_void_p, c.c_void_p
)
_DESTROY_EVENT = address(c.PYFUNCTYPE(c.c_bool, c.c_void_p, c.c_void_p)(lambda event, _: destroy_event(event)))


class ServiceSupport:
    """The type support of one service; `pointer` is that of the rosidl_service_type_support_t."""

    def __init__(
        self, described: DescribedType, request: MessageSupport, response: MessageSupport, event: MessageSupport
    ) -> None:
        self._event = event
        package, kind, name = described.name.split("/")
        callbacks = ServiceCallbacks(
            keep(f"{package}::{kind}".encode()), keep(name.encode()), request.pointer, response.pointer
        )
        members = ServiceMembers(
            keep(f"{package}__{kind}".encode()),
            keep(name.encode()),
            *(c.addressof(part.introspection) for part in (request, response, event)),
        )
        parts = (request.pointer, response.pointer, event.pointer)
        functions = (address(_CreateEvent(self._create_event)), _DESTROY_EVENT, *described.functions)
        handle = address(_Handle(self._handle))
        self.pointer = address(ServiceTypeSupport(IDENTIFIER, address(callbacks), handle, *parts, *functions))
        self._introspection = address(ServiceTypeSupport(INTROSPECTION, address(members), handle, *parts, *functions))

    def _handle(self, _: int, identifier: bytes) -> int | None:
        if identifier == IDENTIFIER:
            return self.pointer
        return self._introspection if identifier == INTROSPECTION else None

    def _create_event(self, info: Any, _: int, request: int | None, response: int | None) -> int | None:
        """Return the address of a new event message, which holds the request or the response, or neither.

        It is None if the message cannot be made: an exception would leave C code with an address of nothing.
        """
        try:
            return self._event.create(self._event_message(info.contents, request, response))
        except Exception as error:
            _log.warning("An event of a service is not published: %s", error)
            return None

    def _event_message(self, seen: Any, request: int | None, response: int | None) -> Any:
        event = self._event.message_class()
        event.info.event_type = seen.event_type
        event.info.stamp.sec = seen.stamp_sec
        event.info.stamp.nanosec = seen.stamp_nanosec
        event.info.client_gid = list(seen.client_gid)
        event.info.sequence_number = seen.sequence_number
        event.request = [message_at(request)] if request else []
        event.response = [message_at(response)] if response else []
        return event


def action_support(
    described: DescribedType, goal: ServiceSupport, result: ServiceSupport, feedback: MessageSupport
) -> int:
    """Return the pointer of the rosidl_action_type_support_t; cancelling and status are the same for all actions."""
    from action_msgs.msg import GoalStatusArray
    from action_msgs.srv import CancelGoal

    for compiled in (CancelGoal, GoalStatusArray):
        if type(compiled)._TYPE_SUPPORT is None:
            type(compiled).__import_type_support__()
    return address(
        ActionTypeSupport(
            goal.pointer,
            result.pointer,
            pointer_in(type(CancelGoal)._TYPE_SUPPORT),
            feedback.pointer,
            pointer_in(type(GoalStatusArray)._TYPE_SUPPORT),
            *described.functions,
        )
    )
