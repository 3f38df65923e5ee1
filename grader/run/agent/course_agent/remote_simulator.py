"""What `gz sim` finds in the box instead of a world and a server of its own: those of the grader.

`import_hooks.py` lets this module stand for `gz.sim.world` and `gz.sim.server`. The program `gz sim` itself is the real
one: its arguments, its output, its exit codes. No truth about the world comes here.
"""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

from .channel import channel
from .grader_requests import ask, hear, when_ended


class RemoteWorld:
    """A world that runs outside. `name` is that in its file."""

    def __init__(self, name: str, models: list[str]) -> None:
        self.name = name
        self._models = models

    @classmethod
    def load(cls, path_or_name: str | Path, **options: Any) -> RemoteWorld:
        """Have a world loaded outside: a built-in one, or a file that was handed in. Raises SimError as it would."""
        from gz_course.sim.gz.sim.errors import SimError
        from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS, find_world

        channel().listen(hear)
        found = find_world(path_or_name).resolve()
        built_in = found.name if found.parent == BUILT_IN_WORLDS else ""
        answer = ask({"world": {"given": str(path_or_name), "path": str(found), "built_in": built_in}})
        if error := answer.get("error"):
            raise SimError(error)
        return cls(answer["name"], answer["models"])

    def model_names(self, static: bool = False) -> list[str]:
        """Names of the models, all of them."""
        return self._models

    def close(self) -> None:
        """It is closed outside."""


class RemoteServer:
    """What keeps a world's time, outside. `paused` is whether it starts so."""

    def __init__(self, world: RemoteWorld, node: Any) -> None:
        self.world = world
        self.paused = False

    def run(
        self, *, stop: threading.Event, update_rate: float | None = None, iterations: int = 0, **options: Any
    ) -> None:
        """Let it run until `stop` is set or the grader ends it."""
        when_ended(stop.set)
        channel().send({"run": {"paused": self.paused, "iterations": iterations}, "waiting": True})
        stop.wait()
        channel().send({"stopped": True})


World, Server = RemoteWorld, RemoteServer  # the names under which `gz sim` imports them
