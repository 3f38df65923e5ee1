"""A fork that has done the imports becomes `course`, with what it was ordered to take over."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import NoReturn

FAULT = 3  # exit code of a fault of the grader


def become_course(
    take_over: Callable[[], object],
    arguments: Sequence[str],
    environment: Mapping[str, str],
    shown: Sequence[str],
    told: Callable[[int], object] = lambda code: None,
) -> NoReturn:
    """Run `course` and end with its exit code, which `told` hears before.

    `take_over` gives this process its folder and streams; an error in it goes to those it has. `shown` is the command
    line that others see.
    """
    from gz_course.grader.course import main as course
    from gz_course.grader.process.command_line import show

    code = FAULT
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        take_over()
        os.environ.clear()
        os.environ.update(environment)
        tempfile.tempdir = None  # it is found anew in this environment
        show("course", *shown)
        sys.argv = ["course", *arguments]
        course()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        with contextlib.suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        with contextlib.suppress(OSError):
            told(code)
        os._exit(code)
