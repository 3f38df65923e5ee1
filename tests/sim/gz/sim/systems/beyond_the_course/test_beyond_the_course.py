"""The room of the systems beyond the course: what stands in it, and that a world finds it."""

from __future__ import annotations

import re
from pathlib import Path

from gz_course.sim.gz.sim.plugins.system import systems

ROOT = Path(__file__).parents[6]
PLACES = ("chapters", "exercises", "sim/gz/sim/worlds", "sim/gz/sim/models")
WRITTEN = {".sdf", ".world", ".ipynb", ".py", ".toml", ".md", ".xacro", ".urdf", ".yaml", ".xml"}
# `gz sim` adds these by its options `--record` and `--playback` and for its view.
ADDED = {"LogRecord", "LogPlayback", "ViewBroadcaster"}


def test_it_holds_what_the_course_does_not_name() -> None:
    files = [path for place in PLACES for path in (ROOT / place).rglob("*") if path.suffix in WRITTEN]
    words = {word for path in files for word in re.findall(r"\w+", path.read_text(errors="replace"))}
    assert {"DiffDrive", "PosePublisher"} <= words
    beyond = {name for name, cls in systems().items() if ".beyond_the_course." in cls.__module__}
    assert len(beyond) >= 6
    assert beyond & words == set(), "the course names them, so they move up"
    named = {cls.__module__ for name, cls in systems().items() if name in words}
    own = {name: cls.__module__ for name, cls in systems().items() if re.search(r"\.systems\.\w+$", cls.__module__)}
    unnamed = {name for name, module in own.items() if module not in named}
    assert unnamed - ADDED == set(), "the course names none of them, so they move down"
