"""A simulated world as a library: load an SDF file, step it, ask for the truth, change it, rewind it.

No transport is needed (`World.load("lidar_room.sdf").step(1000)`); with a node attached the world's systems
take commands and publish. `World.load` reads (`gz.sim.sdf`), builds (`gz.sim.physics`), starts the systems
(`gz.sim.system_manager`); every `step` runs pre_update of all systems, one MuJoCo step, post_update of all
systems. The questions are in `truth`, the changes in `editing`. Same file, seed and commands: same bytes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco

from gz_course.sim.gz.sim.editing import Editing
from gz_course.sim.gz.sim.entities import Entities
from gz_course.sim.gz.sim.errors import LOG, Diagnostics, SimError
from gz_course.sim.gz.sim.physics.builder import build_spec
from gz_course.sim.gz.sim.physics.compiler import compile_world
from gz_course.sim.gz.sim.physics.instability import UNSTABLE, why_unstable
from gz_course.sim.gz.sim.physics.state import copy_state
from gz_course.sim.gz.sim.requests import Requests
from gz_course.sim.gz.sim.sdf.description import Plugin, WorldDescription
from gz_course.sim.gz.sim.sdf.reader import LONGEST_GOOD_STEP_NS, long_step, read_world, read_world_file
from gz_course.sim.gz.sim.sdf.resources import FILES, Resources, find_world
from gz_course.sim.gz.sim.sensors.renderer import check_engine
from gz_course.sim.gz.sim.system_manager import SystemManager, default_plugins
from gz_course.sim.gz.sim.systems.registry import System, UpdateInfo
from gz_course.sim.gz.sim.systems.topics import valid_topic
from gz_course.sim.gz.sim.truth import JointAddress

if TYPE_CHECKING:
    from gz_course.sim.gz.transport import Node

__all__ = ["JointAddress", "World"]

SHORTEST_STEP_NS, LONGEST_STEP_NS = 1_000, 100_000_000


class World(Editing):
    """One world: its description, its MuJoCo model and data, its systems and its clock.

    It belongs to the thread that steps it; other threads go through `requests`.
    """

    def __init__(
        self,
        description: WorldDescription,
        diagnostics: Diagnostics,
        *,
        seed: int = 0,
        node: Node | None = None,
        render_engine: str = "raycast",
        initial_sim_time: float = 0.0,
        server_plugins: Sequence[Plugin] = (),
        resources: Resources = FILES,
    ) -> None:
        """Build and start a world from its description; use `World.load` or `World.from_string`.

        `server_plugins` are systems of the world that its file does not name. What is created later opens the files it
        names with `resources`.
        """
        self.description = description
        self.diagnostics = diagnostics
        self.resources = resources
        self.seed = seed
        self.render_engine = check_engine(render_engine)
        """What the cameras see with: `raycast` or `mujoco`."""
        self.node: Node | None = None
        self.iterations = 0
        self.dropped_commands: dict[str, int] = {}
        """How many commands were refused because they were not finite, by topic."""
        self.entities = Entities(description)
        """The numbers of all entities."""
        self.requests = Requests()
        """What other threads want done between two steps."""
        if not 0.0 <= initial_sim_time <= 1e9:
            raise SimError(f"initial_sim_time must be between 0 and 1e9 seconds, got {initial_sim_time}")
        self._initial_ns = self._origin_ns = round(initial_sim_time * 1e9)
        self._refreshed = -1
        self._models = {model.name: model for model in description.models}
        self._info = UpdateInfo(description.step_size_ns * 1e-9)
        self._manager = SystemManager(self)
        self._begin_editing()
        if not description.plugins:
            description.plugins = default_plugins(description.element)
        self._manager.add_world((*description.plugins, *server_plugins))
        for model in description.models:
            self._manager.add(model)
        self._build()
        self._manager.bind()
        self._manager.start()
        self._manager.check_world()
        for model in description.models:
            self._manager.check_sensors(model)
        diagnostics.refuse()
        if node is not None:
            self.attach(node)

    @classmethod
    def load(
        cls,
        path_or_name: str | Path,
        *,
        seed: int = 0,
        node: Node | None = None,
        render_engine: str = "raycast",
        initial_sim_time: float = 0.0,
        strict: bool = False,
        server_plugins: Sequence[Plugin] = (),
    ) -> World:
        """Load a world by path, by name in GZ_SIM_RESOURCE_PATH, or built in; raise `SdfError` saying where
        and why. With `strict` everything that would be a warning is an error.
        """
        diagnostics = Diagnostics(strict=strict)
        description = read_world_file(find_world(path_or_name), diagnostics)
        return cls(
            description,
            diagnostics,
            seed=seed,
            node=node,
            render_engine=render_engine,
            initial_sim_time=initial_sim_time,
            server_plugins=server_plugins,
        )

    @classmethod
    def from_string(
        cls,
        sdf: str,
        *,
        seed: int = 0,
        file_name: str = "<string>",
        node: Node | None = None,
        render_engine: str = "raycast",
        initial_sim_time: float = 0.0,
        strict: bool = False,
    ) -> World:
        """Load a world from SDF text; `file_name` stands for it in messages."""
        diagnostics = Diagnostics(strict=strict)
        description = read_world(sdf, file_name, diagnostics)
        return cls(
            description,
            diagnostics,
            seed=seed,
            node=node,
            render_engine=render_engine,
            initial_sim_time=initial_sim_time,
        )

    @property
    def topic(self) -> str:
        """Begin of the names of its topics and services: `/world/NAME`, blanks as underscores."""
        return valid_topic(f"/world/{self.name}")

    @property
    def step_size_ns(self) -> int:
        """Length of a step in nanoseconds of simulated time."""
        return self.description.step_size_ns

    @property
    def sim_time_ns(self) -> int:
        """Simulated time in nanoseconds: steps done times step size, exact."""
        return self._origin_ns + self.iterations * self.description.step_size_ns

    @property
    def systems(self) -> list[System]:
        """The systems that run, in the order in which they are called."""
        return self._manager.systems

    @property
    def warnings(self) -> list[str]:
        """Everything this world was warned about, one sentence each."""
        return self.diagnostics.warnings

    def _build(self) -> None:
        """Make MuJoCo's model and its state at time zero; nothing is replaced when MuJoCo refuses."""
        spec = build_spec(self.description, self._manager.servos, self.diagnostics)
        mujoco.set_mju_user_warning(lambda text: LOG.warning("physics: %s", text))
        self.model, self.data = compile_world(spec, self.description, self.diagnostics)
        mujoco.mj_forward(self.model, self.data)
        self._refreshed = -1
        self._find_canonical_links()

    def _rebuild(self) -> None:
        """Build MuJoCo's model anew after the description changed; what was there goes on exactly as it was."""
        model, data = self.model, self.data
        self._build()
        copy_state(model, data, self.model, self.data)
        self._manager.bind()

    def attach(self, node: Node | None) -> None:
        """Let every system subscribe and advertise on a node of its own that has the options of `node`.

        A world is attached once at most; `close` ends what it opened.
        """
        if node is None or node is self.node:
            return
        if self.node is not None:
            raise SimError(f"world '{self.name}' is already attached to a node; load it again for another one")
        self.node = node
        with self.diagnostics.refusing():
            self._manager.connect(node)

    def close(self) -> None:
        """End everything the systems advertised and subscribed to."""
        self._manager.close()

    def step(self, n: int = 1) -> None:
        """Run `n` physics steps with all systems; what other threads asked for is done before each of them.

        Raises `SimError`, naming the body, when the physics came out not finite.
        """
        requests, info, manager, advance = self.requests, self._info, self._manager, mujoco.mj_step
        done, waiting = 0, requests.waiting
        requests.own()
        while done < n:
            if waiting:
                requests.serve()
            model, data = self.model, self.data
            pre_updates, post_updates = manager.pre_updates, manager.post_updates
            origin_ns, step_ns = self._origin_ns, self.description.step_size_ns
            requests.enter_step()
            try:
                while True:  # one step at least, however much is asked for
                    done += 1
                    self.iterations = iterations = self.iterations + 1
                    info.iterations = iterations
                    info.sim_time_ns = origin_ns + iterations * step_ns
                    for pre_update in pre_updates:
                        pre_update(info)
                    advance(model, data)
                    self._refreshed = -1  # A system may have asked for poses before the step.
                    for post_update in post_updates:
                        post_update(info)
                    if waiting or done >= n:
                        break
            finally:
                requests.leave_step()
            if data.warning.number[UNSTABLE].any():
                raise SimError(why_unstable(self.description, model, data, self.sim_time_ns))

    def paused_update(self) -> None:
        """Let the systems that talk while the world is paused do so."""
        info = self._info
        info.iterations, info.sim_time_ns = self.iterations, self.sim_time_ns
        for hook in self._manager.paused_updates:
            hook(info)

    def reset(self, *, time_only: bool = False) -> None:
        """Rewind to the beginning: every topic carries the same bytes again as in the first run.

        What was spawned goes, what was removed or changed comes back as it was. With `time_only` the clock and the
        systems begin anew, and everything stays where it is and moves on.
        """
        self.requests.refuse_inside_step("be reset")
        self.iterations = 0
        self._origin_ns = self._initial_ns
        if time_only:
            self.data.time = 0.0
        else:
            self._reset_state()
        self._refreshed = -1
        self._info.dt = self.step_size_ns * 1e-9
        self._manager.start()

    def _reset_state(self) -> None:
        was = list(self.description.models)
        changed = self._restore()
        now = self.description.models
        self.entities.restart(self.description)
        for model in was:
            if not any(model is each for each in now):
                self._manager.remove(model)
        for model in now:
            if not any(model is each for each in was):
                self._manager.add(model)
        self._models = {model.name: model for model in now}
        if changed:
            self._build()
            self._manager.bind()
            self._manager.connect_new()
        else:
            mujoco.mj_resetData(self.model, self.data)
            mujoco.mj_forward(self.model, self.data)

    def set_physics(self, *, step_size: float | None = None, real_time_factor: float | None = None) -> None:
        """Change the length of a step (s) and the wanted real-time factor while the world runs."""
        self.requests.refuse_inside_step("change its physics")
        if step_size is not None:
            step_ns = round(step_size * 1e9) if abs(step_size) < 1.0 else 0
            if not SHORTEST_STEP_NS <= step_ns <= LONGEST_STEP_NS:
                raise SimError(f"max_step_size must be between 0.000001 and 0.1 seconds, got {step_size}")
            now = self.sim_time_ns
            self._change(self.description, "step_size_ns", step_ns)
            if step_ns > LONGEST_GOOD_STEP_NS:
                self.diagnostics.warn("", long_step(step_size))
            self._origin_ns = now - self.iterations * step_ns
            self._info.dt = step_ns * 1e-9
            self._rebuild()
        if real_time_factor is not None:
            if not (math.isfinite(real_time_factor) and real_time_factor >= 0.0):
                raise SimError(f"real_time_factor must be zero or more, got {real_time_factor}")
            self._change(self.description, "real_time_factor", real_time_factor)

    def drop_command(self, topic: str, what: str) -> None:
        """Count a command that was refused because it is not finite; say so the first time for each topic."""
        count = self.dropped_commands.get(topic, 0) + 1
        self.dropped_commands[topic] = count
        if count == 1:
            self.diagnostics.warn(
                "",
                f"a command on {topic} was dropped because it is not finite ({what}); check for division by zero",
            )
