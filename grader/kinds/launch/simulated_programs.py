"""Gazebo's programs that a submission starts, done here: one world, the bridges to it, and `create` and its like.

The programs in the box are the real ones up to the point where they would begin to simulate or to carry messages
(`agent/course_agent/remote_*.py`); from there on they ask. Nobody else is served (`claims.py`), and what they say is
not trusted: a world is a built-in one, or it is read from what they have passed (`submitted_world.py`); whether it
is paused stands on the command line. No file is opened here because of what they name, and no truth goes back to them.
"""

from __future__ import annotations

import base64
import logging
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import Any

from gz_course.grader.kinds.launch import claims
from gz_course.grader.kinds.launch.robot_facts import MOST_ROBOTS, robot_facts
from gz_course.grader.kinds.launch.submitted_world import SubmittedWorld
from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.grader.run.processes.participant import Participant
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, BridgeError, Direction, HeaderOverrides
from gz_course.sim.gz.sim.errors import LOG, Diagnostics, SimError, one_line
from gz_course.sim.gz.sim.sdf.reader import read_world_file
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

MOST_ENTRIES = 200  # of one bridge
MOST_WARNINGS = 50  # about a world that are shown to its owner
BUILT_IN = frozenset(path.name for path in BUILT_IN_WORLDS.glob("*.sdf"))


@dataclass
class SimulatorProgram:
    """One `gz sim` of the submission; what became of it goes into the recording."""

    who: Participant
    argument: str  # names the world
    world: str = ""  # the built-in file, or the file that was handed in
    error: str = ""
    paused: bool = False
    started_paused: bool = False
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
        files: Collection[str],
        shown: Path,
        seed: int,
        gz_node: Node,
        opened: Callable[[World], None],
        ros: Callable[[], GraderEndpoints],
        entitled: Callable[[Participant, dict[str, Any]], bool] = claims.is_entitled,
        arguments: Callable[[Participant], claims.SimulatorArguments | None] = claims.simulator_arguments,
    ) -> None:
        """Serve whoever is `entitled`. What was handed in has the names `files` in the folder `shown` of the box.

        `arguments(participant)` are those of a `gz sim`.
        """
        self._entitled, self._arguments = entitled, arguments
        self._files = files
        self._shown = shown
        self._seed = seed
        self._gz_node = gz_node
        self._opened = opened
        self._ros = ros
        self._submitted = SubmittedWorld()
        self._warnings: list[str] = []  # about a world that was handed in
        self._model_warnings: list[str] = []  # about models that were created
        self._robots: dict[str, dict[str, Any]] = {}  # models that were created, and their parts
        self.world: World | None = None
        self.over = False  # a world that is asked for now comes too late
        self.building: Callable[[], None] = lambda: None  # called before the simulator gets what was passed
        self.simulators: list[SimulatorProgram] = []
        self.bridges: list[BridgeProgram] = []
        self.calls: list[str] = []
        self.refused: set[str] = set()  # what others than the programs themselves have asked for
        self._loading: list[Participant] = []

    @property
    def loading(self) -> bool:
        """Whether a `gz sim` is reading its world."""
        return any(not each.gone for each in self._loading)

    @property
    def entries(self) -> list[BridgeEntry]:
        """What the bridges that run carry."""
        return [entry for each in self.bridges if not each.stopped for entry in each.entries]

    @property
    def simulator(self) -> SimulatorProgram | None:
        """The first `gz sim` that runs; others stand still beside it."""
        return next((s for s in self.simulators if s.running and s.who.alive and not s.stopped), None)

    def asked(self, who: Participant, message: dict[str, Any]) -> None:
        """Answer a message of one of the programs; others are none of ours."""
        if not self._entitled(who, message):
            if what := claims.asked_for(message):
                self.refused.add(what)
            if message.keys() & {"world", "bridge", "worlds", "call"}:
                who.tell({"answer": {"error": "only Gazebo's own programs are served"}})
        elif part := message.get("asset"):
            self._submitted.take(who.number, part)
        elif "loading" in message:
            self._loading.append(who)
        elif world := message.get("world"):
            self._loading = [each for each in self._loading if each is not who]
            who.tell({"answer": self._load(who, world)})
        elif "run" in message:
            arguments = self._arguments(who)
            for simulator in self.simulators:
                if simulator.who is who and not simulator.error and arguments is not None:
                    simulator.paused, simulator.iterations = arguments.paused, arguments.iterations
                    simulator.started_paused = simulator.paused
                    simulator.running = True
        elif control := message.get("control"):
            for simulator in self.simulators:
                if simulator.who is who:
                    simulator.paused = bool(control["pause"])
        elif asked := message.get("bridge"):
            who.tell({"answer": self._bridge(who, asked)})
        elif "worlds" in message:
            runs = self.world if self.simulator else None
            models = runs.model_names(static=True) if runs else []
            coming = runs is None and not self.over
            who.tell({"answer": {"worlds": [runs.name] if runs else [], "models": models, "coming": coming}})
        elif call := message.get("call"):
            who.tell({"answer": self._call(call)})
        elif "stopped" in message:
            for simulator in self.simulators:
                simulator.stopped |= simulator.who is who
            for bridge in self.bridges:
                bridge.stopped |= bridge.who is who

    def _load(self, who: Participant, asked: dict[str, Any]) -> dict[str, Any]:
        arguments = self._arguments(who)
        argument = arguments.world if arguments else str(asked["given"])
        built_in, path = str(asked["built_in"]), PurePath(str(asked["path"]))
        if arguments and built_in and not claims.names(argument, built_in):
            built_in = ""
        simulator = SimulatorProgram(who, argument, error=str(asked.get("error", "")))
        self.simulators.append(simulator)
        if built_in in BUILT_IN:
            simulator.world = built_in
        elif path.is_relative_to(self._shown) and path.relative_to(self._shown).as_posix() in self._files:
            simulator.world = path.relative_to(self._shown).as_posix()
        elif not simulator.error:
            simulator.error = f"world file '{argument}' is neither a built-in world nor one of the files handed in"
        if not simulator.error and self.world is None:
            simulator.error = self._open(built_in if built_in in BUILT_IN else "", str(asked.get("description", "")))
        if simulator.error or self.world is None:
            return {"error": simulator.error}
        models, warnings = self.world.model_names(static=True), self._warnings[:MOST_WARNINGS]
        return {"name": self.world.name, "models": models, "warnings": warnings}

    def _open(self, built_in: str, description: str) -> str:
        """Build a world, a built-in one or the one at an address; return why that cannot be, empty if it can."""
        if self.over:
            return "the world was asked for when the run was over"
        # A world that was handed in was warned about in the box. Lenient, as `gz sim` is.
        diagnostics = Diagnostics(quiet=True, lenient=True)
        try:
            if built_in:
                read = read_world_file(BUILT_IN_WORLDS / built_in, diagnostics)
            else:
                self.building()
                read = self._submitted.read(description, diagnostics)
            assets = self._submitted.assets
            self.world = World(read, diagnostics, seed=self._seed, node=self._gz_node, resources=assets)
        except SimError as error:
            return str(error)
        except MemoryError:
            raise
        except Exception as error:  # a fault of the world that no check has foreseen
            if built_in:
                raise
            return f"this world cannot be simulated ({type(error).__name__}: {one_line(str(error))[:200]})"
        if not built_in:
            self._warnings = diagnostics.warnings
        self._opened(self.world)
        return ""

    def _bridge(self, who: Participant, asked: dict[str, Any]) -> dict[str, Any]:
        bridge = BridgeProgram(who, str(asked["node"]))
        self.bridges.append(bridge)
        try:
            rows = [dict(row) | {"direction": Direction(row["direction"])} for row in asked["entries"][:MOST_ENTRIES]]
            bridge.entries = [BridgeEntry(**row) for row in rows]
            frame = asked["frame_id"]
            self._ros().set_bridges(self.entries, HeaderOverrides(frame_id=str(frame)) if frame else None)
        except BridgeError as error:
            bridge.errors, bridge.entries = list(error.errors), []
        except (TypeError, ValueError, KeyError) as error:
            bridge.errors, bridge.entries = [str(error)], []
        return {"errors": bridge.errors}

    def _call(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Ask one of the world's services for what `create` and its like ask."""
        from google.protobuf.message import DecodeError

        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory

        if self.world is None or asked["verb"] not in ("create", "remove", "set_pose"):
            return {"done": False}
        data = base64.b64decode(str(asked["data"]))
        if asked["verb"] == "create":
            self.building()
            try:
                factory = EntityFactory.FromString(data)
                factory.ClearField("sdf_filename")
                if description := asked.get("description"):
                    factory.sdf = self._submitted.text(str(description))
                data = factory.SerializeToString()
            except (DecodeError, SimError) as error:
                return {"done": False, "error": str(error)}
        service = f"{self.world.topic}/{asked['verb']}"
        kind, before = str(asked["type"]), len(self.world.warnings)
        there = set(self.world.model_names(static=True))
        with _errors() as errors:
            outcome = self._gz_node.call_raw(f"{service}/blocking", data, kind, Boolean.DESCRIPTOR.full_name, 5000)
        done = bool(outcome.executed and outcome.result and Boolean.FromString(outcome.response).data)
        self.calls.append(f"{asked['verb']}: {'done' if done else 'refused'}")
        warnings = self.world.warnings[before : before + MOST_WARNINGS]
        self._warn_of_model(warnings, asked.get("warnings") if done else None)
        for model in self.world.description.models:
            if model.name not in there and not model.static and len(self._robots) < MOST_ROBOTS:
                self._robots[model.name] = robot_facts(model)
        why = "" if done else next((error.removeprefix(f"{service}/blocking: ") for error in errors), "")
        return {"done": done, "warnings": warnings} | ({"error": why} if why else {})

    def _warn_of_model(self, warnings: list[str], said: object) -> None:
        """Keep warnings about a model, and those that the box `said` of what is not passed: of its URDF."""
        others = said[:MOST_WARNINGS] if isinstance(said, list) else []
        texts = [*warnings, *(one_line(text) for text in others if isinstance(text, str))]
        self._model_warnings += list(dict.fromkeys(texts))[: MOST_WARNINGS - len(self._model_warnings)]

    def facts(self) -> dict[str, Any]:
        """Return what the programs were and did, for the recording; the same for equal runs."""
        return {
            "simulators": [
                {
                    "given": s.argument,
                    "world": s.world,
                    "error": s.error,
                    "paused": s.started_paused,
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
                            "source": e.place,
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
            "refused": sorted(self.refused),
            "model_warnings": self._model_warnings,
            "robots": dict(sorted(self._robots.items())),
        }


@contextmanager
def _errors() -> Iterator[list[str]]:
    """Yield the errors that the simulator logs meanwhile, in which it says why it refuses something."""
    said: list[str] = []
    handler = logging.Handler(logging.ERROR)
    handler.emit = lambda record: said.append(one_line(record.getMessage()))  # type: ignore[method-assign]
    LOG.addHandler(handler)
    try:
        yield said
    finally:
        LOG.removeHandler(handler)
