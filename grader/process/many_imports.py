"""Quick imports of many modules: without the garbage collector, which looks at all they have made again and again, and
without what of Rerun is not used (`late_imports.py`).

Nothing that modules make at their import becomes garbage. So the collector is told to leave all of it alone afterwards,
too: that makes its later work cheap, and keeps memory shared with forks.

Source: Python's documentation of the module gc (`gc.freeze`).
"""

from __future__ import annotations

import contextlib
import gc
import os
import sys
from collections.abc import Iterator

from gz_course.grader.process.late_imports import late_imports

# What libraries read at their import. MuJoCo's window library starts a Python, and the simulator's own renderers do not
# need it. OpenBLAS starts a thread for each processor, which turns idly at first; there is nothing large to compute.
AT_IMPORT = {"MUJOCO_GL": "disabled", "OPENBLAS_NUM_THREADS": "1"}


@contextlib.contextmanager
def many_imports() -> Iterator[None]:
    """Import with the collector off; a variable of `AT_IMPORT` keeps a value that it has."""
    without = [name for name in AT_IMPORT if not os.environ.get(name)]
    given = {name: os.environ.get(name) for name in without}
    os.environ.update({name: AT_IMPORT[name] for name in without})
    late_imports("rerun")
    modules = len(sys.modules)
    gc.disable()
    try:
        yield
    finally:
        if len(sys.modules) > modules:  # else there is nothing new but what may be garbage
            gc.freeze()
        gc.enable()
        for name, value in given.items():
            del os.environ[name]
            if value is not None:
                os.environ[name] = value
