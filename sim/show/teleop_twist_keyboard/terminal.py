"""Keys of a terminal one by one, without echo; the settings of the terminal are restored in the end."""

from __future__ import annotations

import contextlib
import os
import select
import termios
from types import TracebackType

_LFLAG, _CC = 3, 6  # places in what `tcgetattr` returns


class Keys:
    """The keys pressed on the terminal behind a descriptor, inside a `with` statement.

    Ctrl-C is a key here, as for `teleop_twist_keyboard` on a full installation.
    """

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def __enter__(self) -> Keys:
        self._before = termios.tcgetattr(self._descriptor)
        settings = termios.tcgetattr(self._descriptor)
        settings[_LFLAG] &= ~(termios.ICANON | termios.ECHO | termios.ISIG | termios.IEXTEN)
        settings[_CC][termios.VMIN], settings[_CC][termios.VTIME] = 1, 0
        termios.tcsetattr(self._descriptor, termios.TCSANOW, settings)
        return self

    def pressed(self, timeout_s: float | None) -> str | None:
        """Wait for keys up to a time [s], None: for ever; return them, "" if there were none, None at the end."""
        if not select.select([self._descriptor], [], [], timeout_s)[0]:
            return ""
        try:
            read = os.read(self._descriptor, 1024)
        except OSError:  # the window was closed
            return None
        return read.decode("latin-1") or None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with contextlib.suppress(termios.error):  # the window was closed
            termios.tcsetattr(self._descriptor, termios.TCSANOW, self._before)
