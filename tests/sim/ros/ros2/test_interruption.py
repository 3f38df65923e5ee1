"""A signal that arrives where Python drops exceptions takes effect at the next check."""

import gc
import os
import signal
import sys

import pytest

from gz_course.sim.ros.ros2 import command_line, interruption


class Deaf:
    """An object that is interrupted during its deletion."""

    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        for _ in range(1000):
            pass


class HalfMade:
    """An object that is interrupted while it is made, such as a Future of rclpy."""

    def __init__(self):
        os.kill(os.getpid(), signal.SIGINT)
        for _ in range(1000):
            pass
        self.made = True

    def __del__(self):
        assert self.made


class Broken:
    """An object whose deletion fails."""

    def __del__(self):
        raise ValueError("a fault of its own")


@pytest.fixture
def listening(monkeypatch):
    before = [(number, signal.getsignal(number)) for number in (signal.SIGINT, signal.SIGTERM)]
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    interruption.listen()
    yield
    interruption.listen()
    for number, handler in before:
        signal.signal(number, handler)


def test_an_interrupt_that_python_drops_is_heard_later_and_not_printed(listening, capsys):
    interruption.check()
    del (deaf := [Deaf()])[:]
    assert deaf == []
    with pytest.raises(KeyboardInterrupt):
        interruption.check()
    assert capsys.readouterr().err == ""


def test_an_object_that_an_interrupt_left_half_made_says_nothing(listening, capsys):
    with pytest.raises(KeyboardInterrupt):
        HalfMade()
    gc.collect()
    assert capsys.readouterr().err == ""


def test_another_fault_that_python_drops_is_printed_as_ever(listening, capsys):
    del (broken := [Broken()])[:]
    assert broken == []
    assert "a fault of its own" in capsys.readouterr().err


def test_what_c_code_makes_of_an_interruption_is_no_error(listening, monkeypatch, capsys):
    def converts(*_):
        try:
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(1000):
                pass
        except KeyboardInterrupt:
            raise RuntimeError("Unable to convert call argument '0' to Python object") from None
        raise AssertionError

    monkeypatch.setattr(command_line, "run", converts)
    assert command_line._explained(["topic", "list"]) == 2
    assert capsys.readouterr().err == ""
