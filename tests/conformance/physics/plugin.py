"""Runs a scene in the dartsim plugin of Gazebo Fortress (gz-physics 5, DART 6.12), from Debian's packages.

`dartsim.cc` is built when it is asked for first.
"""

from __future__ import annotations

import functools
import hashlib
import shutil
import subprocess
import tempfile
from pathlib import Path

from gz_course.tests.conformance.physics.orders import read, servos
from gz_course.tests.conformance.physics.scene import Force, Kick, Scene, Servo, Track

PLUGIN = Path("/usr/lib/x86_64-linux-gnu/libignition-physics5-dartsim-plugin.so.5")
PACKAGES = (
    "libignition-physics5-dartsim-plugin5 libignition-physics-core-dev libignition-physics-sdf-dev libeigen3-dev "
    "g++ pkg-config"
)
_LIBRARIES = ("ignition-physics5", "ignition-physics5-sdf", "ignition-plugin1-loader", "sdformat12")
_SOURCE = Path(__file__).with_name("dartsim.cc")
_BUILT = Path(__file__).parents[3] / "build" / "conformance"  # which git ignores, and `make clean` removes


def why_absent() -> str:
    """A sentence if the plugin cannot be run; empty if it can."""
    found = PLUGIN.is_file() and shutil.which("g++") and shutil.which("pkg-config") and _flags()
    return "" if found else f"Gazebo's own physics was NOT run: apt-get install {PACKAGES} (Debian 12)"


def _flags() -> list[str]:
    asked = subprocess.run(["pkg-config", "--cflags", "--libs", *_LIBRARIES], capture_output=True, text=True)
    return [] if asked.returncode else asked.stdout.split()


@functools.cache
def _program() -> Path:
    """The program; it is kept between runs in the checkout, because its templates take long to compile."""
    mark = hashlib.sha256(_SOURCE.read_bytes()).hexdigest()[:16]
    program = _BUILT / f"dartsim_{mark}"
    if not program.is_file():
        _BUILT.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=_BUILT) as folder:
            made = Path(folder) / "dartsim"
            command = ["g++", "-std=c++17", "-O0", _SOURCE, "-o", made, *_flags()]
            subprocess.run(command, check=True, timeout=900)
            made.replace(program)  # whole at once: several tests may make it at the same time
    return program


def run(scene: Scene) -> Track:
    orders = [f"link {name.replace('::', ' ', 1)}" for name in scene.links]
    orders += [f"joint {name.replace('::', ' ', 1)}" for name in scene.joints]
    world = read(scene)
    for actions, steps in scene.phases():
        for action in servos(world, actions):
            if isinstance(action, Kick):
                orders.append(f"kick {action.model} {' '.join(map(str, (*action.linear, *action.angular)))}")
            elif isinstance(action, Servo | Force):
                verb = "servo" if isinstance(action, Servo) else "force"
                orders.append(f"{verb} {action.joint.replace('::', ' ', 1)} {action.value}")
        orders.append(f"run {steps} {scene.stride} {scene.step}")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "world.sdf"
        path.write_text(scene.sdf)
        done = subprocess.run(
            [_program(), PLUGIN, path], input="\n".join(orders) + "\n", capture_output=True, text=True, timeout=600
        )
    assert done.returncode == 0, f"{scene.name}: {done.stderr}"
    return scene.track([[float(word) for word in line.split()] for line in done.stdout.splitlines()])
