"""Gives a class made at run time its type support, when rclpy first asks for it."""

from __future__ import annotations

import functools
from typing import Any

from gz_course.sim.ros.rosidl.c_structs import capsule
from gz_course.sim.ros.rosidl.definitions import description
from gz_course.sim.ros.rosidl.described_type import DescribedType
from gz_course.sim.ros.rosidl.message_type_support import MessageSupport
from gz_course.sim.ros.rosidl.service_type_support import ServiceSupport, action_support


def add_message_support(message_class: Any) -> None:
    """Set the capsules of a message class."""
    for name, value in _message(message_class).capsules().items():
        setattr(type(message_class), name, value)


def add_service_support(service_class: Any) -> None:
    """Set the capsule of a service class, and those of its messages."""
    for message_class in (service_class.Request, service_class.Response, service_class.Event):
        add_message_support(message_class)
    type(service_class)._TYPE_SUPPORT = capsule(_service(service_class).pointer)


def add_action_support(action_class: Any) -> None:
    """Set the capsule of an action class, and those of its services and messages."""
    impl = action_class.Impl
    for service_class in (impl.SendGoalService, impl.GetResultService):
        add_service_support(service_class)
    for message_class in (action_class.Goal, action_class.Result, action_class.Feedback, impl.FeedbackMessage):
        add_message_support(message_class)
    services = (_service(impl.SendGoalService), _service(impl.GetResultService))
    pointer = action_support(_described(action_class), *services, _message(impl.FeedbackMessage))
    type(action_class)._TYPE_SUPPORT = capsule(pointer)


@functools.cache
def _message(message_class: Any) -> MessageSupport:
    return MessageSupport(message_class, _described(message_class))


@functools.cache
def _service(service_class: Any) -> ServiceSupport:
    parts = (service_class.Request, service_class.Response, service_class.Event)
    return ServiceSupport(_described(service_class), *map(_message, parts))


def _described(made: Any) -> DescribedType:
    package, kind, _ = made.__module__.split(".")
    return DescribedType(description(f"{package}/{kind}/{made.__name__}"))
