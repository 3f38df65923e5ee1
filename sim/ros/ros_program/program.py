"""The frame of a ROS program with one node: arguments, signals, error sentences and exit code.

`run` starts ROS, creates the node with the parameters of the command line, and calls the program's own function.
Importing this module loads no ROS, so that `run` handles signals from the start.
"""

from __future__ import annotations

import contextlib
import signal
import sys
from collections.abc import Callable
from types import FrameType
from typing import TYPE_CHECKING

from gz_course.sim.foreign_variables import set_aside
from gz_course.sim.postponed_signal import postponed
from gz_course.sim.ros.ros_program.errors import Failure, UsageError, first_line
from gz_course.sim.ros.ros_program.spinner import STOP_SIGNALS, block_stop_signals
from gz_course.sim.terminal_text import guard

if TYPE_CHECKING:
    from rclpy.node import Node

_INTERRUPTED = 130


def run(
    program: str,
    node_name: str,
    work: Callable[[Node, list[str]], int],
    help_text: str,
    argv: list[str] | None = None,
    *,
    lasting: bool = False,
    images: bool = False,
) -> int:
    """Call `work(node, arguments without ROS's own)`; return its exit code, 2 for a UsageError, 1 for a Failure.

    A `lasting` program ends with `wait_for_signal` and exit code 0; another one is interrupted by SIGINT and SIGTERM
    wherever it is, with exit code 130. A program that sends `images` gets a larger segment of shared memory. Why a
    lasting program could not start also stands in ROS's folder of logs (`last_words`).
    """
    if argv is None:
        guard()
    argv = sys.argv if argv is None else [program, *argv]
    if {"-h", "--help", "-help"} & set(argv[1:]):
        print(help_text, end="")
        return 0
    set_aside(program)
    if lasting:
        # Fetched in one place, a signal is neither lost in the wait set of a library nor handled amid the setup.
        block_stop_signals()
    else:
        for number in STOP_SIGNALS:
            signal.signal(number, _interrupt)
    try:
        if lasting:
            _remember(program, ())
        return _with_node(node_name, work, argv, images)
    except UsageError as error:
        for sentence in error.sentences:
            print(f"{program}: {sentence}", file=sys.stderr)
        if lasting:
            _remember(program, error.sentences)
        return 2
    except Failure as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"{program}: interrupted", file=sys.stderr)
        return _INTERRUPTED


def _remember(program: str, sentences: tuple[str, ...]) -> None:
    """Leave the last words of the program, or forget those of the last start if there are none."""
    import os
    import time

    from rclpy.logging import get_logging_directory

    from gz_course.sim.gz.transport.environment import default_partition
    from gz_course.sim.ros.ros_program.last_words import LastWords, forget, leave

    text = os.environ.get("ROS_DOMAIN_ID", "")
    domain = int(text) if text.isdigit() else 0
    words = LastWords(program, os.getpid(), time.time(), domain, default_partition(), sentences)
    with contextlib.suppress(Exception):  # ROS finds no folder for logs
        if sentences:
            leave(get_logging_directory(), words)
        else:
            forget(get_logging_directory(), words.place)


def _interrupt(number: int, frame: FrameType | None) -> None:
    if postponed(number, frame):
        return
    for each in STOP_SIGNALS:  # a second signal must not interrupt the cleanup
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


def _with_node(node_name: str, work: Callable[[Node, list[str]], int], argv: list[str], images: bool) -> int:
    import rclpy
    from rclpy.impl.implementation_singleton import rclpy_implementation
    from rclpy.signals import SignalHandlerOptions
    from rclpy.utilities import remove_ros_args

    from gz_course.sim.ros.ros_program.shared_memory import segment_for_images

    context = rclpy.Context()
    try:
        arguments = remove_ros_args(argv)[1:]
        rclpy.init(args=argv, context=context, signal_handler_options=SignalHandlerOptions.NO)
        with segment_for_images() if images else contextlib.nullcontext():
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
