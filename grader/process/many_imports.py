"""Quick imports of many modules: without the garbage collector, which looks at all they have made again and again.

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


@contextlib.contextmanager
def many_imports() -> Iterator[None]:
    """Import with the collector off; also without MuJoCo's window library, which starts a Python at its import.

    The simulator's own renderers need neither it nor the variable, which keeps a value that it has.
    """
    given = os.environ.get("MUJOCO_GL")
    os.environ["MUJOCO_GL"] = given or "disabled"
    modules = len(sys.modules)
    gc.disable()
    try:
        yield
    finally:
        if len(sys.modules) > modules:  # else there is nothing new but what may be garbage
            gc.freeze()
        gc.enable()
        if given is None:
            del os.environ["MUJOCO_GL"]
