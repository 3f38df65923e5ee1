"""Questions to the grader that are answered, such as those of Gazebo's programs that the grader serves.

A process asks one thing at a time; the answer comes in the thread that listens, if there is one.
"""

from __future__ import annotations

import _thread
import threading
from _queue import SimpleQueue  # that of `queue` is replaced by one whose waiters count as idle
from collections.abc import Callable
from typing import Any

from .channel import channel
from .python_3_threads import at_work

_answers: SimpleQueue[dict[str, Any]] = SimpleQueue()
_asking = _thread.allocate_lock()
_ended = threading.Event()
_on_end: list[Callable[[], None]] = []


def hear(message: dict[str, Any] | None) -> bool:
    """Take a message of the grader; False if it is none of ours. None: there will be no more."""
    if message is None:
        _answers.put({"error": "the simulator has gone"})
        _end()
    elif "answer" in message:
        _answers.put(message["answer"])
    elif "end" in message:
        _end()
    else:
        return False
    return True


def ask(question: dict[str, Any]) -> dict[str, Any]:
    """Return the answer to a question; wait for it as long as the grader is there.

    The process counts as at work meanwhile, because it goes on with the answer at once.
    """
    with _asking, at_work():
        channel().send(question)
        if not channel().listening:
            _receive_answer()
        return _answers.get()


def _receive_answer() -> None:
    """Skip orders: nobody is there yet who could carry them out."""
    while (message := channel().receive()) is not None and "answer" not in message:
        pass
    hear(message)


def when_ended(act: Callable[[], None]) -> None:
    """Call something, in another thread, when the grader ends what was asked for."""
    _on_end.append(act)
    if _ended.is_set():
        act()


def _end() -> None:
    _ended.set()
    for act in _on_end:
        act()
