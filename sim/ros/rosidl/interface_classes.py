"""Makes the Python classes of an interface: a message, a service or an action.

Source: rosidl_generator_py 0.22 (`_srv.py.em`, `_action.py.em`)
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl.definitions import definition
from gz_course.sim.ros.rosidl.interface_text import messages_of
from gz_course.sim.ros.rosidl.message_class import message_class
from gz_course.sim.ros.rosidl.nested_classes import module_name


def classes_of(path: Path, package: str) -> dict[str, Any]:
    """Return all that the module of an interface holds: classes and metaclasses by name."""
    interface = definition(path, package)
    module = f"{package}.{path.parent.name}.{module_name(path.stem)}"
    made: dict[str, Any] = {}
    for message in messages_of(interface):
        made[message.structure.namespaced_type.name] = message_class(message, module, _support_message)
    if isinstance(interface, idl.Action):
        for service in (interface.send_goal_service, interface.get_result_service):
            made[service.namespaced_type.name] = _service(service, module, made)
        made[path.stem] = _action(interface, module, made)
    elif isinstance(interface, idl.Service):
        made[path.stem] = _service(interface, module, made)
    return made | {type(each).__name__: type(each) for each in made.values()}


def _support_message(made: Any) -> None:
    from gz_course.sim.ros.rosidl.type_support import add_message_support

    add_message_support(made)


def _support_service(made: Any) -> None:
    from gz_course.sim.ros.rosidl.type_support import add_service_support

    add_service_support(made)


def _support_action(made: Any) -> None:
    from gz_course.sim.ros.rosidl.type_support import add_action_support

    add_action_support(made)


def _service(service: idl.Service, module: str, made: dict[str, Any]) -> Any:
    name = service.namespaced_type.name
    parts = {part: made[f"{name}_{part}"] for part in ("Request", "Response", "Event")}
    return _collection("service", name, module, _support_service, parts)


def _action(action: idl.Action, module: str, made: dict[str, Any]) -> Any:
    from action_msgs.msg import GoalStatusArray
    from action_msgs.srv import CancelGoal

    name = action.namespaced_type.name
    wrapped = {
        "SendGoalService": made[action.send_goal_service.namespaced_type.name],
        "GetResultService": made[action.get_result_service.namespaced_type.name],
        "FeedbackMessage": made[action.feedback_message.structure.namespaced_type.name],
        "CancelGoalService": CancelGoal,
        "GoalStatusMessage": GoalStatusArray,
    }
    parts = {part: made[f"{name}_{part}"] for part in ("Goal", "Result", "Feedback")}
    parts["Impl"] = type("Impl", (), {"__module__": module, "__qualname__": f"{name}.Impl", **wrapped})
    return _collection("action", name, module, _support_action, parts)


def _collection(kind: str, name: str, module: str, support: Callable[[Any], None], parts: dict[str, Any]) -> Any:
    """Return the class of a service or action, which only holds other classes."""
    made: list[Any] = []

    def __init__(self: Any) -> None:
        raise NotImplementedError(f"{kind.capitalize()} classes can not be instantiated")

    body = {
        "__module__": module,
        "__doc__": f"Metaclass of {kind} '{name}'.",
        "_TYPE_SUPPORT": None,
        "__import_type_support__": classmethod(lambda metaclass: support(made[0])),
    }
    metaclass = type(f"Metaclass_{name}", (type,), body)
    made.append(metaclass(name, (), {"__module__": module, "__qualname__": name, "__init__": __init__, **parts}))
    return made[0]
