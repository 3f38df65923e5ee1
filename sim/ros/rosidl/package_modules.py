"""Fills the modules of a package whose interfaces are made at run time.

`PACKAGE.msg` has a name for each `.msg`; the module behind it, such as `PACKAGE.msg._tf_message`, is made when the
name is first used.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.rosidl import interface_classes
from gz_course.sim.ros.rosidl.nested_classes import module_name
from gz_course.sim.ros.rosidl.packages import share_folder

_EXPORTED = {
    "msg": ("",),
    "srv": ("", "_Event", "_Request", "_Response"),
    "action": (
        *("", "_GetResult_Event", "_GetResult_Request", "_GetResult_Response"),
        *("_SendGoal_Event", "_SendGoal_Request", "_SendGoal_Response"),
    ),
}


def exists(prefix: str, package: str, parts: list[str]) -> bool:
    """Whether a package has this module; `parts` are the names after that of the package."""
    if len(parts) == 2:
        return parts[1] in _modules(prefix, package, parts[0])
    return len(parts) == 0 or (len(parts) == 1 and bool(_modules(prefix, package, parts[0])))


def fill(module: ModuleType, prefix: str) -> None:
    """Give a module its content. Raises InvalidInterfaceError for a text that is not right."""
    package, *parts = module.__name__.split(".")
    if not parts:
        return
    if len(parts) == 1:
        _fill_folder(module, prefix, package, parts[0])
        return
    path = _modules(prefix, package, parts[0])[parts[1]]
    vars(module).update(interface_classes.classes_of(path, package))


def _fill_folder(module: Any, prefix: str, package: str, kind: str) -> None:
    files = _modules(prefix, package, kind)
    owners = {f"{path.stem}{end}": name for name, path in files.items() for end in _EXPORTED[kind]}

    def __getattr__(name: str) -> Any:
        if name in owners:
            found = getattr(importlib.import_module(f"{package}.{kind}.{owners[name]}"), name)
            setattr(module, name, found)
            return found
        hint = "" if name.startswith("_") else did_you_mean(name, owners)
        raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}{hint}")

    module.__getattr__ = __getattr__
    module.__dir__ = lambda: sorted({*vars(module), *owners, *files})
    module.__all__ = sorted(owners)


def _modules(prefix: str, package: str, kind: str) -> dict[str, Path]:
    """Return the modules of one kind of interfaces: name -> file."""
    folder = Path(share_folder(prefix, package), kind)
    return {module_name(path.stem): path for path in sorted(folder.glob(f"*.{kind}"))}
