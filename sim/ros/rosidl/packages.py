"""Finds packages whose interfaces are made at run time, and the files of all interfaces.

Such a package lies in an ament prefix as a compiled one does: its texts are `share/PACKAGE/msg/*.msg`, `srv/*.srv` and
`action/*.action`. The file `share/ament_index/resource_index/run_time_interfaces/PACKAGE` marks it. The folder
`sim/ros/interfaces` is such a prefix.

Source: REP-122, https://www.ros.org/reps/rep-0122.html
"""

from __future__ import annotations

import os

MARKS = "run_time_interfaces"
ALL = "rosidl_interfaces"  # the index of all packages with interfaces, compiled ones too
INDEX = os.path.join("share", "ament_index", "resource_index")  # noqa: PTH118 - imported at every start of Python
BUILT_IN = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "interfaces")  # noqa: PTH100, PTH118, PTH120

_seen: dict[tuple[str, tuple[str, ...]], dict[str, str]] = {}


def prefixes() -> list[str]:
    """Return the ament prefixes in the order of search; the built-in one is the last."""
    found = [each for each in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if each]
    return [*found, *([] if BUILT_IN in found else [BUILT_IN])]


def packages(index: str = MARKS) -> dict[str, str]:
    """Return the packages in an index: name -> prefix; the first prefix wins."""
    searched = tuple(prefixes())
    if (index, searched) not in _seen:
        _seen[index, searched] = _listed(index, searched)
    return _seen[index, searched]


def _listed(index: str, searched: tuple[str, ...]) -> dict[str, str]:
    found: dict[str, str] = {}
    for prefix in searched:
        try:
            names = os.listdir(os.path.join(prefix, INDEX, index))  # noqa: PTH118, PTH208
        except OSError:
            continue
        for name in names:
            found.setdefault(name, prefix)
    return found


def forget() -> None:
    """Have the index read again, because packages may have come."""
    _seen.clear()


def share_folder(prefix: str, package: str) -> str:
    """Return the folder in which a package has its texts."""
    return os.path.join(prefix, "share", package)  # noqa: PTH118
