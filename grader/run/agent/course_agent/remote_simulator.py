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
        """Have a world loaded outside: a built-in one by its name, a file that was handed in by its content.

        Raises SimError as it would.
        """
        from gz_course.sim.gz.sim.errors import LOG, Diagnostics, SimError
        from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS, find_world

        channel().listen(hear)
        found = find_world(path_or_name).resolve()
        built_in = found.name if found.parent == BUILT_IN_WORLDS else ""
        channel().send({"loading": True})
        asked = {"given": str(path_or_name), "path": str(found), "built_in": built_in, "description": "", "error": ""}
        diagnostics = Diagnostics(strict=bool(options.get("strict")))
        if not built_in:
            try:
                asked["description"] = _handed_over(found, diagnostics)
            except SimError as error:
                asked["error"] = str(error)
        answer = ask({"world": asked})
        if "error" in answer:
            raise SimError(answer["error"])
        for warning in answer.get("warnings", []):
            if warning not in diagnostics.warnings:  # from building the world, not from reading it
                LOG.warning("%s", warning)
        return cls(answer["name"], answer["models"])

    def model_names(self, static: bool = False) -> list[str]:
        """Names of the models, all of them."""
        return self._models

    def close(self) -> None:
        """Do nothing: the grader closes the world."""


def _handed_over(file: Path, diagnostics: Any) -> str:
    """Read a world as the simulator does, with all its warnings, and hand it over; return its address."""
    from .handing_over import hand_over  # isort: skip - before anything imports MuJoCo

    from gz_course.sim.gz.sim.sdf.reader import read_world
    from gz_course.sim.gz.sim.sdf.resources import read_text

    text = read_text(file)
    read_world(text, str(file), diagnostics)
    diagnostics.refuse()
    return hand_over(text, str(file))


class RemoteServer:
    """What keeps a world's time, outside. `paused` is whether it starts so."""

    offers_view = False

    def __init__(self, world: RemoteWorld, node: Any) -> None:
        self.world = world
        self.paused = False
        self._node = node

    def run(
        self, *, stop: threading.Event, update_rate: float | None = None, iterations: int = 0, **options: Any
    ) -> None:
        """Let it run until `stop` is set or the grader ends it."""
        when_ended(stop.set)
        channel().send({"run": {"paused": self.paused, "iterations": iterations}, "waiting": True})
        self._offer_control()
        stop.wait()
        channel().send({"stopped": True})

    def _offer_control(self) -> None:
        """Offer the service that pauses the world and lets it run; nothing else can be asked of it here."""
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl

        def control(request: Any) -> Any:
            others = [field.name for field, _ in request.ListFields() if field.name not in ("header", "pause")]
            if not others:
                channel().send({"control": {"pause": request.pause}, "waiting": True})
            return Boolean(data=not others)

        self._node.advertise_service(f"/world/{self.world.name}/control", WorldControl, Boolean, control)


World, Server = RemoteWorld, RemoteServer  # the names under which `gz sim` imports them
