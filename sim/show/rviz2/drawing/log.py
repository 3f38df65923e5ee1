"""rcl_interfaces/Log (`/rosout`) and std_msgs/String: lines of text."""

from __future__ import annotations

from typing import Any

# Source: rcl_interfaces/msg/Log.msg
LEVELS = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "CRITICAL"}


def draw(canvas: Any, entity: str, message: Any) -> None:
    canvas.text(entity, f"[{message.name}] {message.msg}", LEVELS.get(message.level, "INFO"))


def draw_string(canvas: Any, entity: str, message: Any) -> None:
    canvas.text(entity, message.data)


DRAWN = {"rcl_interfaces/msg/Log": draw, "std_msgs/msg/String": draw_string}
