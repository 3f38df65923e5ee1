"""Says of a package that cannot be imported what it is and what to do.

The finder is the last one that Python asks, so it answers only for what is not there. It raises the error that Python
would raise, with a longer text; who asks whether a package exists (`importlib.util.find_spec`) hears that it does not.
Only `sys` is imported, because this runs at every start of Python.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # instead of that of `typing`, which would slow every start
if TYPE_CHECKING:
    from types import FrameType

_IMPORT = "_find_and_load_unlocked"  # the function of importlib that an `import` statement calls


class MissingPackages:
    """A finder that finds nothing, and says so."""

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> None:
        if "." in fullname or not _is_imported(sys._getframe(1)):
            return
        from gz_course.sim.ros.prefix.package_advice import advice

        if text := advice(fullname):
            raise ModuleNotFoundError(f"No module named '{fullname}': {text}", name=fullname)


def _is_imported(frame: FrameType | None) -> bool:
    """Return whether an `import` asks, not `importlib.util.find_spec`; a frame of importlib is between."""
    return frame is not None and frame.f_back is not None and frame.f_back.f_code.co_name == _IMPORT


def install() -> None:
    """Add the finder behind those of this process."""
    if not any(type(each).__name__ == MissingPackages.__name__ for each in sys.meta_path):
        sys.meta_path.append(MissingPackages())
