"""Environment variables that belong to another installation and would end our programs at their start.

`set_aside` takes them out of the environment of this process, and so of all that it starts.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, MutableMapping
from pathlib import Path

MIDDLEWARE = "rmw_fastrtps_cpp"
PROTOBUF = ("python", "upb")
# Source: mujoco/gl_context.py and rerun_sdk/rerun of the wheels
ON, OFF = ("1", "true", "on", "enable", "enabled"), ("0", "false", "off", "disable", "disabled")
GRAPHICS = ("", "glfw", "egl", "osmesa", *ON, *OFF)
_MUJOCO, _RERUN = "MUJOCO_GL", "RERUN"
_RMW, _PROTOBUF = "RMW_IMPLEMENTATION", "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION"


def set_aside(program: str, *, ros: bool = True) -> None:
    """Remove the variables that cannot hold here; say so in one line each on stderr. `ros`: also those of ROS."""
    for sentence in removed(os.environ, ros=ros):
        print(f"{program}: {sentence}", file=sys.stderr)


def removed(environment: MutableMapping[str, str], *, ros: bool = True) -> list[str]:
    """Remove the variables that cannot hold here from an environment; return one sentence for each.

    A middleware that a sourced ROS 2 brings is left alone.
    """
    sentences = []
    middleware = environment.get(_RMW, "")
    if ros and middleware not in ("", MIDDLEWARE) and not _is_sourced(middleware, environment):
        del environment[_RMW]
        sentences.append(f"{_RMW}={middleware} is ignored: the wheels of ROS bring {MIDDLEWARE} only")
    implementation = environment.get(_PROTOBUF, "")
    if implementation not in ("", *PROTOBUF):
        del environment[_PROTOBUF]
        sentences.append(f"{_PROTOBUF}={implementation} is ignored: protobuf has {' and '.join(PROTOBUF)} here")
    graphics = environment.get(_MUJOCO, "")
    if graphics.strip().lower() not in GRAPHICS:
        del environment[_MUJOCO]
        sentences.append(f"{_MUJOCO}={graphics} is ignored: MuJoCo knows glfw, egl and osmesa")
    recording = environment.get(_RERUN, "")
    if recording.lower() in OFF:
        del environment[_RERUN]
        sentences.append(f"{_RERUN}={recording} is ignored: every run is recorded")
    return sentences


def _is_sourced(middleware: str, environment: Mapping[str, str]) -> bool:
    prefixes = environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return any(prefix and (Path(prefix) / "lib" / f"lib{middleware}.so").exists() for prefix in prefixes)
