"""A signal that comes where Python drops exceptions is heard at the next check."""

import os
import signal

import pytest

from ros2 import interruption


class Deaf:
    """Is interrupted while it is deleted."""

    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        for _ in range(1000):
            pass


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_interrupt_that_python_drops_is_heard_later(monkeypatch):
    before = [(number, signal.getsignal(number)) for number in (signal.SIGINT, signal.SIGTERM)]
    interruption.listen()
    try:
        interruption.check()
        monkeypatch.setattr("sys.unraisablehook", lambda info: None)
        del (deaf := [Deaf()])[:]
        assert deaf == []
        with pytest.raises(KeyboardInterrupt):
            interruption.check()
    finally:
        interruption.listen()
        for number, handler in before:
            signal.signal(number, handler)
