"""Self-check of the patches: compares what they depend on with what is installed, before anything is patched.

`rclpy_7_1*.py` and `python_3*.py` list what they depend on. The agent checks that as it patches; the grader checks its
own copies when a run begins (`grader/run/run_loop.py`), so that a changed library ends in one clear sentence.
"""

from __future__ import annotations

import importlib

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping

# `module:Class.function` -> (the parameters it takes, the names its body uses); empty if any will do.
Reliance = tuple[str, str]


def misfits(relied_upon: Mapping[str, Reliance]) -> list[str]:
    """Return one clause for each item that is missing, takes other parameters, or no longer uses a name."""
    found = []
    for place, (parameters, names) in relied_upon.items():
        module, _, path = place.partition(":")
        name = f"{module}.{path}"
        try:
            function = importlib.import_module(module)
            for part in path.split("."):
                function = getattr(function, part)
        except (ImportError, AttributeError):
            found.append(f"{name} is missing")
            continue
        code = getattr(function, "__code__", None)
        if code is None:
            if parameters or names:
                found.append(f"{name} is no Python function")
            continue
        takes = code.co_varnames[: code.co_argcount]
        if parameters and takes != tuple(parameters.split()):
            found.append(f"{name} takes ({', '.join(takes)}) where ({', '.join(parameters.split())}) is expected")
        known = {*code.co_names, *code.co_varnames, *code.co_cellvars}
        found += [f"{name} does not use {each!r} any more" for each in names.split() if each not in known]
    return found


def require(relied_upon: Mapping[str, Reliance]) -> None:
    """Raise ImportError with the first misfit, if there is one."""
    if found := misfits(relied_upon):
        raise ImportError(f"this Python cannot be kept in step: {found[0]}")
