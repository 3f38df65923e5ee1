"""The main program of a run whose submission is a node: runs the submitted Python file as `__main__`, unmodified.

Started as `python -P -m course_agent.run_node FILE ARGUMENTS`. rclpy is imported before the file's folder is on the
path, so no file beside it can replace a module of ours or of ROS. Tracebacks look as if the file had been started
alone.
"""

from __future__ import annotations

import ctypes
import runpy
import signal
import sys
from pathlib import Path

from . import rclpy_7_1
from .tracebacks import print_traceback

PR_SET_PDEATHSIG = 1


def main() -> None:
    """Run the file named in argv[1] with the remaining arguments."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # never outlive the grader
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # inherited from a grader that a script started with `&`
        signal.signal(signal.SIGINT, signal.default_int_handler)
    import rclpy  # noqa: F401

    monitor = rclpy_7_1.monitor()
    file = sys.argv[1]
    sys.argv = sys.argv[1:]
    sys.path.insert(0, str(Path(file).parent))
    try:
        runpy.run_path(file, run_name="__main__")
    except SystemExit:
        raise
    except BaseException as error:
        print_traceback(error)
        sys.exit(130 if isinstance(error, KeyboardInterrupt) else 1)
    finally:
        monitor.flush()


if __name__ == "__main__":
    main()
