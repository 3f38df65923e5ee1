"""Gazebo's programs that a submission starts, done here: one world, the bridges to it, and `create` and its like.

The programs in the box are the real ones up to the point where they would begin to simulate or to carry messages
(`agent/course_agent/remote_*.py`); from there on they ask. What they say is not trusted: a
world is a built-in one or a file that was handed in, whatever path they name, and no truth goes back to them.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.grader.run.processes.participant import Participant
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.sim.ros_gz_bridge.entry import BridgeEntry, BridgeError, Direction, HeaderOverrides

MOST_ENTRIES = 200  # of one bridge
URI = re.compile(r"<(?:uri|filename)>\s*(.*?)\s*</")
BUILT_IN_MODEL = re.compile(r"model://\w+")  # all that a world that was handed in may name: it is read outside the box


@dataclass
class SimulatorProgram:
    """One `gz sim` of the submission; what became of it goes into the recording."""

    who: Participant
    argument: str  # names the world
    world: str = ""  # the built-in file, or the file that was handed in
    error: str = ""
    paused: bool = False
    iterations: int = 0  # 0: without end
    running: bool = False
    stopped: bool = False  # it was ended by a signal, and has noticed


@dataclass
class BridgeProgram:
    """One `parameter_bridge` of the submission."""

    who: Participant
    node: str
    entries: list[BridgeEntry] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    stopped: bool = False


class SimulatedPrograms:
    """Answers the programs. `world` is None until one was loaded; `opened(world)` is called then."""

    def __init__(
        self,
        files: Path,
        shown: Path,
        seed: int,
        gz_node: Node,
        opened: Callable[[World], None],
        ros: Callable[[], GraderEndpoints],
    ) -> None:
        """`files` holds a copy of what was handed in, which is called `shown` in the box."""
        self._files = files
        self._shown = shown
        self._seed = seed
        self._gz_node = gz_node
        self._opened = opened
        self._ros = ros
        self.world: World | None = None
        self.simulators: list[SimulatorProgram] = []
        self.bridges: list[BridgeProgram] = []
        self.calls: list[str] = []

    @property
    def simulator(self) -> SimulatorProgram | None:
        """The first `gz sim` that runs; others stand still beside it."""
        return next((s for s in self.simulators if s.running and not s.who.gone and not s.stopped), None)

    def asked(self, who: Participant, message: dict[str, Any]) -> None:
        """Answer a message of one of the programs; others are none of ours."""
        if world := message.get("world"):
            who.tell({"answer": self._load(who, world)})
        elif run := message.get("run"):
            for simulator in self.simulators:
                if simulator.who is who:
                    simulator.paused, simulator.iterations = bool(run["paused"]), max(0, int(run["iterations"]))
                    simulator.running = True
        elif asked := message.get("bridge"):
            who.tell({"answer": self._bridge(who, asked)})
        elif "worlds" in message:
            runs = self.world if self.simulator else None
            models = runs.model_names(static=True) if runs else []
            who.tell({"answer": {"worlds": [runs.name] if runs else [], "models": models}})
        elif call := message.get("call"):
            who.tell({"answer": {"done": self._call(call)}})
        elif "stopped" in message:
            for simulator in self.simulators:
                simulator.stopped |= simulator.who is who
            for bridge in self.bridges:
                bridge.stopped |= bridge.who is who

    def _load(self, who: Participant, asked: dict[str, Any]) -> dict[str, Any]:
        argument, built_in, path = str(asked["given"]), str(asked["built_in"]), Path(str(asked["path"]))
        simulator = SimulatorProgram(who, argument)
        self.simulators.append(simulator)
        if built_in and (BUILT_IN_WORLDS / Path(built_in).name).is_file():
            simulator.world = Path(built_in).name
            file: Path = BUILT_IN_WORLDS / simulator.world
        elif own := self._handed_in(path):
            simulator.world = path.relative_to(self._shown).as_posix()
            file = own
            foreign = [
                uri for uri in URI.findall(file.read_text(errors="replace")) if not BUILT_IN_MODEL.fullmatch(uri)
            ]
            if foreign or file.suffix not in (".sdf", ".world"):
                what = f"it names '{foreign[0][:200]}'" if foreign else f"{simulator.world} is no .sdf file"
                simulator.error = f"a world that is graded may use built-in models only; {what}"
        else:
            simulator.error = f"world file '{argument}' is neither a built-in world nor one of the files handed in"
        if not simulator.error and self.world is None:
            try:
                self.world = World.load(file, seed=self._seed, node=self._gz_node)
            except SimError as error:
                simulator.error = str(error).replace(str(self._files), str(self._shown))
            else:
                self._opened(self.world)
        if simulator.error or self.world is None:
            return {"error": simulator.error}
        return {"name": self.world.name, "models": self.world.model_names(static=True)}

    def _handed_in(self, path: Path) -> Path | None:
        """Return our own copy of a file of the submission; None if the path means anything else."""
        if not path.is_relative_to(self._shown) or ".." in path.parts:
            return None
        own = self._files / path.relative_to(self._shown)
        return own if own.is_file() else None

    def _bridge(self, who: Participant, asked: dict[str, Any]) -> dict[str, Any]:
        bridge = BridgeProgram(who, str(asked["node"]))
        self.bridges.append(bridge)
        try:
            rows = [dict(row) | {"direction": Direction(row["direction"])} for row in asked["entries"][:MOST_ENTRIES]]
            bridge.entries = [BridgeEntry(**row) for row in rows]
            standing = [entry for each in self.bridges if not each.stopped for entry in each.entries]
            frame = asked["frame_id"]
            self._ros().set_bridges(standing, HeaderOverrides(frame_id=str(frame)) if frame else None)
        except BridgeError as error:
            bridge.errors, bridge.entries = list(error.errors), []
        except (TypeError, ValueError, KeyError) as error:
            bridge.errors, bridge.entries = [str(error)], []
        return {"errors": bridge.errors}

    def _call(self, asked: dict[str, Any]) -> bool:
        """Ask one of the world's services for what `create` and its like ask."""
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean

        if self.world is None or asked["verb"] not in ("create", "remove", "set_pose"):
            return False
        data = base64.b64decode(str(asked["data"]))
        service = f"{self.world.topic}/{asked['verb']}/blocking"
        outcome = self._gz_node.call_raw(service, data, str(asked["type"]), Boolean.DESCRIPTOR.full_name, 5000)
        done = bool(outcome.executed and outcome.result and Boolean.FromString(outcome.response).data)
        self.calls.append(f"{asked['verb']}: {'done' if done else 'refused'}")
        return done

    def facts(self) -> dict[str, Any]:
        """Return what the programs were and did, for the recording; the same for equal runs."""
        return {
            "simulators": [
                {
                    "given": s.argument,
                    "world": s.world,
                    "error": s.error,
                    "paused": s.paused,
                    "iterations": s.iterations,
                    "ran": s.running,
                }
                for s in self.simulators
            ],
            "bridges_started": [
                {
                    "node": b.node,
                    "errors": b.errors,
                    "entries": [
                        {
                            "source": e.source.rpartition("/")[2],
                            "ros_topic": e.ros_topic,
                            "ros_type": e.ros_type,
                            "gz_topic": e.gz_topic,
                            "gz_type": e.gz_type,
                            "direction": e.direction.value,
                        }
                        for e in b.entries
                    ],
                }
                for b in sorted(self.bridges, key=lambda b: (b.node, [e.ros_topic for e in b.entries]))
            ],
            "calls": sorted(self.calls),
        }
