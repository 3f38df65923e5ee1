"""Environment variables that belong to another installation and would end our programs at their start.

`set_aside` takes them out of the environment of this process, and so of all that it starts.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, MutableMapping
from pathlib import Path

MIDDLEWARE = "rmw_fastrtps_cpp"
_RMW = "RMW_IMPLEMENTATION"
# Source: mujoco/gl_context.py, rerun/__init__.py and rerun/error_utils.py of the wheels
ON, OFF = ("1", "true", "on", "enable", "enabled"), ("0", "false", "off", "disable", "disabled")
# Variable -> whether a value of it holds here; and why another does not.
RULES: Mapping[str, tuple[Callable[[str], bool], str]] = {
    _RMW: (lambda value: value in ("", MIDDLEWARE), f"the wheels of ROS bring {MIDDLEWARE} only"),
    "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": (
        lambda value: value in ("", "python", "upb"),
        "protobuf has python and upb here",
    ),
    "MUJOCO_GL": (
        lambda value: value.strip().lower() in ("", "glfw", "egl", "osmesa", *ON, *OFF),
        "MuJoCo knows glfw, egl and osmesa",
    ),
    "RERUN": (lambda value: value.lower() in ("", *ON), "every run is recorded"),
    "RERUN_STRICT": (
        lambda value: value.lower() in ("0", "false", "off", "no", "1", "true", "on", "yes"),
        "Rerun knows on and off",
    ),
}


def set_aside(program: str, *, ros: bool = True) -> None:
    """Remove the variables that cannot hold here; say so in one line each on stderr. `ros`: also those of ROS."""
    for sentence in removed(os.environ, ros=ros):
        print(f"{program}: {sentence}", file=sys.stderr)


def removed(environment: MutableMapping[str, str], *, ros: bool = True) -> list[str]:
    """Remove the variables that cannot hold here from an environment; return one sentence for each.

    A middleware that a sourced ROS 2 brings is left alone.
    """
    sentences = []
    for name, (holds, why) in RULES.items():
        value = environment.get(name)
        if value is None or holds(value) or (name == _RMW and (not ros or _is_sourced(value, environment))):
            continue
        del environment[name]
        sentences.append(f"{name}={value} is ignored: {why}")
    return sentences


def _is_sourced(middleware: str, environment: Mapping[str, str]) -> bool:
    prefixes = environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return any(prefix and (Path(prefix) / "lib" / f"lib{middleware}.so").exists() for prefix in prefixes)
