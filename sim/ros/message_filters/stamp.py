"""The time of a message: the stamp of its header, or the time of its arrival."""

from __future__ import annotations

from typing import Any

import rclpy.logging
from rclpy.clock import ROSClock
from rclpy.logging import LoggingSeverity
from rclpy.time import Time


def stamp_of(message: Any) -> Time | None:
    """Return the stamp of a message, or None if it has no header with a stamp."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    if stamp is None or hasattr(stamp, "nanoseconds"):
        return stamp
    return Time.from_msg(stamp)


def arrival_time() -> Time:
    """Return the ROS time now."""
    return ROSClock().now()


def refuse_headerless(logger_name: str) -> None:
    """Warn that a message without a stamp is dropped."""
    logger = rclpy.logging.get_logger(logger_name)
    logger.set_level(LoggingSeverity.INFO)
    logger.warning(
        "can not use message filters for messages without timestamp information when 'allow_headerless' is disabled: "
        "the message is dropped; the constructor's option allow_headerless=True gives it the ROS time of its arrival"
    )
