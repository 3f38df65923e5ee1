"""The executor of a ROS program, in a thread beside the main one."""

from __future__ import annotations

import os
import signal
import threading
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.ros_program.errors import Failure, first_line

if TYPE_CHECKING:
    from rclpy.node import Node

STOP_SIGNALS = {signal.SIGINT, signal.SIGTERM}
_LOOK_S = 0.5  # [s] until a signal is noticed that another thread got in the moment before the wait
_END_S = 2.0  # [s] for the end of a running callback when the executor is shut down


def block_stop_signals() -> None:
    """Keep SIGINT and SIGTERM for `wait_for_signal`. Linux keeps a blocked signal even if the parent ignores it (a
    shell's `&`).

    A thread that is there already, such as one of NumPy's, may still get a signal; it is passed on to the main one.
    """
    main = threading.get_ident()
    signal.pthread_sigmask(signal.SIG_BLOCK, STOP_SIGNALS)
    for number in STOP_SIGNALS:
        signal.signal(number, lambda number, _: signal.pthread_kill(main, number))


class Spinner:
    """A thread that runs the callbacks of a node inside a `with` statement.

    A callback that raises ends the thread and sends this process SIGTERM; `error` is then the text of the exception.
    """

    def __init__(self, node: Node) -> None:
        from rclpy.executors import SingleThreadedExecutor

        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, name="ros_executor", daemon=True)
        self._ending = False
        self.error = ""

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException, ShutdownException

        try:
            self._executor.spin()
        except (ExternalShutdownException, ShutdownException):
            pass
        except Exception as error:
            if self._ending:  # the executor is taken down while it looks for something to do
                return
            self.error = first_line(error)
            os.kill(os.getpid(), signal.SIGTERM)

    def __enter__(self) -> Spinner:
        self._thread.start()
        return self

    def __exit__(self, *_: Any) -> None:
        self._ending = True
        self._executor.shutdown(timeout_sec=_END_S)
        self._thread.join(_END_S)


def wait_for_signal(node: Node) -> int:
    """Run the callbacks of a `lasting` program's node until SIGINT or SIGTERM; return the exit code 0.

    Raises Failure if a callback raised.
    """
    with Spinner(node) as spinner:
        while signal.sigtimedwait(STOP_SIGNALS, _LOOK_S) is None:
            pass  # handlers run between two waits
    if spinner.error:
        raise Failure(f"a callback failed: {spinner.error}")
    return 0
