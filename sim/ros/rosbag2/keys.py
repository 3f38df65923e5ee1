"""Keys of the terminal while a bag is recorded or played; Ctrl-C remains a signal."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import termios
import threading
from collections.abc import Callable, Iterator, Mapping

SPACE, RIGHT, UP, DOWN = " ", "\x1b[C", "\x1b[A", "\x1b[B"
_LFLAG = 3  # the place of the local modes in what `tcgetattr` returns


@contextlib.contextmanager
def keys(actions: Mapping[str, Callable[[], None]]) -> Iterator[bool]:
    """Call the action of each key that is pressed inside the block; yield whether there is a terminal."""
    if not _is_ours():
        yield False
        return
    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    raw = termios.tcgetattr(terminal)
    raw[_LFLAG] &= ~(termios.ICANON | termios.ECHO)
    closed, closing = os.pipe()
    listener = threading.Thread(target=_listen, args=(terminal, closed, actions), name="keys", daemon=True)
    try:
        termios.tcsetattr(terminal, termios.TCSANOW, raw)
        listener.start()
        yield True
    finally:
        os.close(closing)
        if listener.is_alive():
            listener.join()
        os.close(closed)
        with contextlib.suppress(termios.error):  # the window was closed
            termios.tcsetattr(terminal, termios.TCSANOW, before)


def _is_ours() -> bool:
    """Return whether the standard input is a terminal whose keys go to this process."""
    try:
        return sys.stdin.isatty() and os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except (AttributeError, OSError, ValueError):  # closed, or the terminal of another session
        return False


def _listen(terminal: int, closed: int, actions: Mapping[str, Callable[[], None]]) -> None:
    while True:
        ready, _, _ = select.select([terminal, closed], [], [])
        if closed in ready:
            return
        try:
            pressed = os.read(terminal, 1024).decode("latin-1")
        except OSError:  # the window was closed
            return
        if not pressed:
            return
        for name in pressed_keys(pressed):
            if name in actions:
                actions[name]()


def pressed_keys(text: str) -> Iterator[str]:
    """Yield single keys: an arrow is three characters."""
    place = 0
    while place < len(text):
        length = 3 if text.startswith("\x1b[", place) and len(text) - place >= 3 else 1
        yield text[place : place + length]
        place += length
