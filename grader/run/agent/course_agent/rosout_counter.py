"""Counts what the nodes of this process log to /rosout, so that the grader can wait until it has arrived.

rclpy logs in C; the counts are taken where it calls C. A message counts only if a node with a publisher on /rosout
wrote it: a node may have switched it off, may be in another domain, and what is logged after the shutdown goes to the
console alone.
"""

from __future__ import annotations

from collections import Counter
from typing import Any

from . import other_domains
from .executor_monitor import ExecutorMonitor

ROSOUT = "/rosout"


def watch_logging(monitor: ExecutorMonitor) -> None:
    """Patch nodes, loggers and contexts of rclpy, which has been imported."""
    from rclpy.context import Context
    from rclpy.impl.implementation_singleton import rclpy_implementation as rcl
    from rclpy.node import Node

    loggers: Counter[str] = Counter()  # names of those that publish on /rosout
    contexts: dict[str, Any] = {}  # their contexts, which a signal may end
    make, destroy, shutdown = Node.__init__, Node.destroy_node, Context.shutdown
    log, add, remove = (
        rcl.rclpy_logging_rcutils_log,
        rcl.rclpy_logging_rosout_add_sublogger,
        rcl.rclpy_logging_rosout_remove_sublogger,
    )

    def noted_make(node: Any, *args: Any, **kwargs: Any) -> None:
        make(node, *args, **kwargs)
        name = (node.get_name(), node.get_namespace())
        if not other_domains.apart(node) and name in {
            (e.node_name, e.node_namespace) for e in node.get_publishers_info_by_topic(ROSOUT)
        }:
            loggers[node.get_logger().name] = 1
            contexts[node.get_logger().name] = node.context

    def noted_destroy(node: Any) -> Any:
        done = destroy(node)
        loggers.pop(node.get_logger().name, None)
        return done

    def noted_shutdown(context: Any) -> None:
        shutdown(context)
        loggers.clear()
        contexts.clear()

    def noted_add(parent: str, child: str) -> bool:
        added: bool = add(parent, child)
        if added and loggers[parent]:
            loggers[f"{parent}.{child}"] += 1
            contexts[f"{parent}.{child}"] = contexts[parent]
        return added

    def noted_remove(parent: str, child: str) -> Any:
        loggers.subtract({f"{parent}.{child}": 1})
        return remove(parent, child)

    def noted_log(severity: Any, name: str, *args: Any) -> None:
        counts = loggers[name] > 0 and contexts[name].ok()
        log(severity, name, *args)
        if counts:
            monitor.count_log()

    rcl.rclpy_logging_rcutils_log = noted_log
    rcl.rclpy_logging_rosout_add_sublogger = noted_add
    rcl.rclpy_logging_rosout_remove_sublogger = noted_remove
    Node.__init__ = noted_make
    Node.destroy_node = noted_destroy
    Context.shutdown = noted_shutdown
