"""Messages for nodes that cannot take them at the moment: a callback sleeps, or nobody spins the node.

In reality they wait in DDS, and when the queue of a subscription is full the oldest is lost. Nobody could tell when a
message has arrived there, so the grader has them taken (the order `take`), and they wait here, as many as the QoS
allows. The executor gets them when nothing else is ready, in the order of the node's subscriptions.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any

SERVICE_DEPTH = 10  # requests or responses kept, as in the default QoS of services
Took = Callable[[Any, Any], bool]


class Kept:
    """Stands for a subscription, service or client in rclpy's `_take_...`, which then finds what was kept."""

    def __init__(self, entity: Any, item: Any) -> None:
        self._entity = entity
        self._item = item
        self.handle = self

    def __enter__(self) -> Kept:
        return self

    def __exit__(self, *error: object) -> None: ...

    def __getattr__(self, name: str) -> Any:
        return getattr(self._entity, name)

    def _take(self, *arguments: Any) -> Any:
        return self._item

    take_message = service_take_request = take_response = _take


def blocked(nodes: Iterable[Any]) -> Iterator[tuple[str, Any]]:
    """Yield what no waiting executor looks at: the kind (subscription, service, client, action), and the entity."""
    for node in nodes:
        executor = node.executor
        waits = getattr(executor, "course_wait", None) is not None and node in executor.get_nodes()
        if waits and getattr(executor, "_executor", None) is None:
            continue
        for kind in ("subscription", "service", "client", "action"):
            for entity in list(_entities(node, kind)):
                if not (waits and executor.can_execute(entity)) and not hasattr(entity, "course_waited"):
                    yield kind, entity


def _entities(node: Any, kind: str) -> Iterable[Any]:
    """Return the entities of a node of one kind; `action` are the clients and servers of actions."""
    if kind == "action":
        return [each for each in node.waitables if hasattr(each, "course_take_all")]
    found: Iterable[Any] = getattr(node, f"{kind}s")
    return found


def fill(kind: str, entity: Any, took: Took) -> None:
    """Take everything that has arrived. `took(entity, item)` returns whether it is to be kept."""
    take = {
        "subscription": lambda: entity.handle.take_message(entity.msg_type, entity.raw),
        "service": lambda: entity.handle.service_take_request(entity.srv_type.Request),
        "client": lambda: entity.handle.take_response(entity.srv_type.Response),
    }[kind]
    with entity.handle:
        while (item := take()) is not None and item[0] is not None and item[1] is not None:
            if took(entity, item):
                kept(entity).append(item)


def kept(entity: Any) -> deque[Any]:
    """Return what is kept for an entity."""
    found: deque[Any] | None = getattr(entity, "course_kept", None)
    if found is None:
        profile = entity.qos_profile if hasattr(entity, "msg_type") else None
        depth = SERVICE_DEPTH if profile is None else None if profile.history.name == "KEEP_ALL" else profile.depth
        found = entity.course_kept = deque(maxlen=depth if depth is None else max(1, depth))
    return found


def has_kept(entity: Any) -> bool:
    """Return whether anything is kept for an entity."""
    return bool(getattr(entity, "course_kept", None))


def ready(executor: Any, nodes: Any) -> Any:
    """Return what an executor is to do next with what was kept, as `wait_for_ready_callbacks` does; None if nothing."""
    for node in executor.get_nodes() if nodes is None else nodes:
        for kind in ("subscription", "client", "service", "action"):
            for entity in _entities(node, kind):
                if has_kept(entity) and executor.can_execute(entity):
                    take = executor._take_waitable if kind == "action" else getattr(executor, f"_take_{kind}")
                    return executor._make_handler(entity, node, take), entity, node
    return None


def is_copy(subscription: Any, message: Any) -> bool:
    """Return whether a message has the stamp of the one before it; False for a message without a stamp."""
    if not hasattr(subscription.msg_type, "header"):
        return False
    # A raw subscription gets bytes: a header of four bytes that names the encoding, then the stamp.
    raw = isinstance(message, bytes)
    stamp = message[4:12] if raw else (message.header.stamp.sec, message.header.stamp.nanosec)
    before, subscription.course_stamp = getattr(subscription, "course_stamp", None), stamp
    return bool(stamp == before)
