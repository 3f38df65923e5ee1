"""The keys on a real pseudo-terminal, what is published for each, and the terminal afterwards."""

import os
import pty
import signal
import subprocess
import sys
import termios
import threading

import pytest

from gz_course.sim.show.teleop_twist_keyboard.keys import HELP, MOVES, SPEEDS, Command
from gz_course.sim.show.teleop_twist_keyboard.terminal import Keys
from gz_course.tests.warm_process import WarmPopen

MODULE = "gz_course.sim.show.teleop_twist_keyboard.teleop_twist_keyboard"
DEADLINE_S = 120.0


class Terminal:
    """A pseudo-terminal: what is typed into it, what it shows, its settings."""

    def __init__(self):
        self.typing, self.descriptor = pty.openpty()
        self.shown = ""
        self._changed = threading.Condition()
        self.before = termios.tcgetattr(self.descriptor)
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        while True:
            try:
                read = os.read(self.typing, 4096)
            except OSError:  # nobody holds the other end
                return
            with self._changed:
                self.shown += read.decode()
                self._changed.notify_all()

    def wait_for(self, words):
        with self._changed:
            assert self._changed.wait_for(lambda: words in self.shown, DEADLINE_S), self.shown

    def type(self, keys):
        os.write(self.typing, keys.encode())

    @property
    def is_as_before(self):
        return termios.tcgetattr(self.descriptor) == self.before

    def close(self):
        os.close(self.descriptor)
        self._reader.join(DEADLINE_S)
        os.close(self.typing)


@pytest.fixture
def terminal():
    made = Terminal()
    yield made
    made.close()


@pytest.fixture
def teleop(programs, terminal):
    """Start the program on the terminal; it is killed in the end if it still runs."""
    made = []

    def start(*words):
        made.append(
            WarmPopen(
                [sys.executable, "-P", "-m", MODULE, *words],
                stdin=terminal.descriptor,
                stdout=terminal.descriptor,
                stderr=subprocess.STDOUT,
                env=programs.environment,
                start_new_session=True,
            )
        )
        terminal.wait_for("currently:\tspeed")
        return made[-1]

    yield start
    for process in made:
        process.kill()
        process.wait(DEADLINE_S)


def test_each_key_is_one_message_and_the_last_one_is_zero(teleop, terminal, ros_node, spin_until):
    from geometry_msgs.msg import TwistStamped

    heard = []
    ros_node.create_subscription(TwistStamped, "/x", heard.append, 10)
    process = teleop("--ros-args", "-r", "cmd_vel:=/x", "-p", "stamped:=true", "-p", "frame_id:=base", "-p", "turn:=2")
    assert not terminal.is_as_before
    spin_until(lambda: ros_node.count_publishers("/x") == 1, "the publisher")
    spin_until(lambda: terminal.type("k") or heard, "the first message")
    terminal.type("iwU\x1b\x03")

    def driven():  # the keys typed last
        seen = [(m.twist.linear.x, m.twist.linear.y, m.twist.angular.z) for m in heard]
        return seen[next((n for n, each in enumerate(seen) if any(each)), len(seen)) :]

    spin_until(lambda: process.poll() is not None and len(driven()) >= 5, "all messages")
    assert driven() == [(0.5, 0, 0), pytest.approx((0.55, 0, 0)), pytest.approx((0.55, 0.55, 0)), (0, 0, 0), (0, 0, 0)]
    assert {m.header.frame_id for m in heard} == {"base"} and heard[0].header.stamp.sec > 0
    assert process.returncode == 0 and terminal.is_as_before
    assert "speed 0.55\tturn 2" in terminal.shown and "Traceback" not in terminal.shown


def test_a_signal_stops_the_robot_and_leaves_the_terminal_as_it_was(teleop, terminal, ros_node, spin_until):
    from geometry_msgs.msg import Twist

    heard = []
    ros_node.create_subscription(Twist, "/cmd_vel", heard.append, 10)
    process = teleop("--ros-args", "-p", "repeat_rate:=50.0", "-p", "key_timeout:=1000.0")
    spin_until(lambda: ros_node.count_publishers("/cmd_vel") == 1, "the publisher")
    terminal.type("j")
    spin_until(lambda: len(heard) > 2, "the same again and again")
    assert {each.angular.z for each in heard} == {1.0}
    process.send_signal(signal.SIGTERM)
    spin_until(lambda: process.poll() is not None and heard[-1].angular.z == 0.0, "the end")
    assert process.returncode == 0 and terminal.is_as_before
    assert "Traceback" not in terminal.shown


def test_the_terminal_is_restored_after_an_exception(terminal):
    with pytest.raises(ZeroDivisionError), Keys(terminal.descriptor) as keys:
        terminal.type("ab")
        assert keys.pressed(DEADLINE_S) == "ab" and keys.pressed(0.0) == ""
        assert not termios.tcgetattr(terminal.descriptor)[3] & (termios.ECHO | termios.ICANON | termios.ISIG)
        raise ZeroDivisionError
    assert terminal.is_as_before


def test_without_a_terminal(programs):
    code, said = programs.finished(MODULE)
    assert code == 1 and said.startswith("teleop_twist_keyboard: standard input is not a terminal")
    assert said.count("\n") == 1


def test_unusable_parameters(ros_node):
    from gz_course.sim.ros.ros_program.errors import UsageError
    from gz_course.sim.show.teleop_twist_keyboard.teleop_twist_keyboard import DEFAULTS, checked

    assert checked(DEFAULTS) == DEFAULTS
    for wrong, sentence in (({"frame_id": "base"}, "only with stamped:=true"), ({"speed": -1.0}, "speed must be")):
        with pytest.raises(UsageError, match=sentence):
            checked(DEFAULTS | wrong)


def test_the_keys():
    assert set(MOVES) == set("uiojlm,.UIOJLM<>tb") and set(SPEEDS) == set("qzwxec")
    for key in [*MOVES, *SPEEDS]:
        assert key in HELP, key
    command = Command(1.0, 1.0)
    assert [command.press(key) for key in "oe"] == [False, True]
    assert command.velocity == (1.0, 0.0, 0.0, -1.1)
    command.press("k")
    assert command.velocity == (0, 0, 0, 0)
