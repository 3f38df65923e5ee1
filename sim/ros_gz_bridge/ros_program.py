"""A ROS program of one node: its arguments, its signals, its faults in one sentence, its exit code.

Used by ``parameter_bridge`` and the executables of ``ros_gz_sim``, ``ros_gz_image`` and ``robot_state_publisher``.
``run`` starts ROS, makes the
node with the parameters of the command line, and hands both to the program's own function. Importing this module
loads nothing heavy, so that signals are in hand from the start.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.node import Node

_STOP_SIGNALS = {signal.SIGINT, signal.SIGTERM}
_INTERRUPTED = 130
_END_S = 2.0  # for the callback under way; what it uses is taken down after that


class UsageError(Exception):
    """The arguments make no sense: one sentence for each fault, exit code 2."""

    def __init__(self, *sentences: str) -> None:
        super().__init__("\n".join(sentences))
        self.sentences = sentences


class Failure(Exception):
    """What was asked for could not be done: one sentence, exit code 1."""


def run(
    program: str,
    node_name: str,
    work: Callable[[Node, list[str]], int],
    help_text: str,
    argv: list[str] | None = None,
    *,
    lasting: bool = False,
    pictures: bool = False,
) -> int:
    """Call ``work(node, arguments without ROS's own)``; return its exit code, 2 for a usage error, 1 for a failure.

    A ``lasting`` program ends with ``wait_for_signal`` and exit code 0; another one is interrupted by SIGINT and
    SIGTERM wherever it is, with exit code 130. One that sends ``pictures`` gets room for them in shared memory.
    """
    argv = sys.argv if argv is None else [program, *argv]
    if {"-h", "--help", "-help"} & set(argv[1:]):
        print(help_text, end="")
        return 0
    if lasting:
        # Blocked in every thread and fetched by one sigwait: none is lost in a library's wait set, none strikes in
        # the middle of setting up, and one the parent ignores (a shell's '&') is heard: Linux keeps a blocked signal
        # whatever its handler.
        signal.pthread_sigmask(signal.SIG_BLOCK, _STOP_SIGNALS)
    else:
        for number in _STOP_SIGNALS:
            signal.signal(number, _interrupt)
    try:
        return _with_node(node_name, work, argv, pictures)
    except UsageError as error:
        for sentence in error.sentences:
            print(f"{program}: {sentence}", file=sys.stderr)
        return 2
    except Failure as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"{program}: interrupted", file=sys.stderr)
        return _INTERRUPTED


def _interrupt(*_: object) -> None:
    for number in _STOP_SIGNALS:  # saying goodbye is not interrupted again
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def _with_node(node_name: str, work: Callable[[Node, list[str]], int], argv: list[str], pictures: bool) -> int:
    import rclpy
    from rclpy.impl.implementation_singleton import rclpy_implementation
    from rclpy.signals import SignalHandlerOptions
    from rclpy.utilities import remove_ros_args

    from gz_course.sim.ros_gz_bridge.shared_memory import room_for_pictures

    context = rclpy.Context()
    try:
        arguments = remove_ros_args(argv)[1:]
        rclpy.init(args=argv, context=context, signal_handler_options=SignalHandlerOptions.NO)
        with room_for_pictures() if pictures else contextlib.nullcontext():
            node = rclpy.create_node(node_name, context=context, automatically_declare_parameters_from_overrides=True)
    except rclpy_implementation.UnknownROSArgsError as error:
        raise UsageError(f"ROS does not know these arguments after --ros-args: {error}") from None
    except Exception as error:
        context.try_shutdown()
        raise UsageError(f"ROS did not start: {first_line(error)}") from None
    try:
        return work(node, arguments)
    finally:
        node.destroy_node()
        context.try_shutdown()


def first_line(error: BaseException) -> str:
    """The first line of an error's text without places in ROS's C sources, or its type if it says nothing."""
    line = next(iter(str(error).splitlines()), "").strip()
    return re.sub(r", at /\S+:\d+", "", line) or type(error).__name__


class Spinner:
    """Runs the callbacks of a node in a thread; use it in a ``with`` statement."""

    def __init__(self, node: Node) -> None:
        from rclpy.executors import SingleThreadedExecutor

        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, name="ros_executor", daemon=True)
        self.broken: str = ""
        """What a callback died of; empty while all is well."""

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException, ShutdownException

        try:
            self._executor.spin()
        except (ExternalShutdownException, ShutdownException):
            pass
        except Exception as error:
            self.broken = first_line(error)
            os.kill(os.getpid(), signal.SIGTERM)

    def __enter__(self) -> Spinner:
        self._thread.start()
        return self

    def __exit__(self, *_: Any) -> None:
        self._executor.shutdown(timeout_sec=_END_S)
        self._thread.join(_END_S)


def wait_for_signal(node: Node) -> int:
    """Run the callbacks of a ``lasting`` program's node until SIGINT or SIGTERM: 0; raise ``Failure`` if one broke."""
    with Spinner(node) as spinner:
        signal.sigwait(_STOP_SIGNALS)
    if spinner.broken:
        raise Failure(f"it broke down: {spinner.broken}")
    return 0
