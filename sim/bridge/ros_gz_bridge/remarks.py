"""What conversions say of messages that are sent on although a part of them has no place on the other side.

The original bridge sends such messages on, too, and prints a line or nothing. Here a conversion calls `remark`, and the
link that asked for the conversion (`converted`) warns and counts.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any


class _Listening(threading.local):
    remarks: list[str] | None = None


_listening = _Listening()


def remark(text: str) -> None:
    """Say in a conversion what became of a part that does not fit."""
    if _listening.remarks is not None:
        _listening.remarks.append(text)


def converted(convert: Callable[[Any], Any], message: Any) -> tuple[Any, list[str]]:
    """Return the converted message, and what was remarked. Raises the exceptions of `convert`."""
    remarks = _listening.remarks = []
    try:
        return convert(message), remarks
    finally:
        _listening.remarks = None
