"""A simulated world as a library: load an SDF file, step it, read its true state, edit it, reset it.

No transport is needed (`World.load("lidar_room.sdf").step(1000)`); with a node attached the systems of the world
receive commands and publish. `World.load` reads the file (`gz.sim.sdf`), builds MuJoCo's model (`gz.sim.physics`) and
starts the systems (`gz.sim.running_systems`). Every step calls pre_update of all systems, steps MuJoCo, and calls
post_update of all systems. `truth` returns poses and velocities, `editor` changes the world. The same file, seed and
commands give the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco

from gz_course.sim.gz.sim.editing.editor import Editor
from gz_course.sim.gz.sim.entities import Entities
from gz_course.sim.gz.sim.errors import Diagnostics, SimError
from gz_course.sim.gz.sim.physics import integrator, overlaps, sleeping, welds
from gz_course.sim.gz.sim.physics.builder import build_spec
from gz_course.sim.gz.sim.physics.compiler import compile_world, hear_warnings
from gz_course.sim.gz.sim.physics.fast_bodies import FastBodies
from gz_course.sim.gz.sim.physics.instability import UNSTABLE, why_unstable
from gz_course.sim.gz.sim.physics.joint_limits import JointLimits
from gz_course.sim.gz.sim.physics.state import copy_state
from gz_course.sim.gz.sim.plugins.system import UpdateInfo
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.rendering.renderer import check_engine
from gz_course.sim.gz.sim.requests import Requests
from gz_course.sim.gz.sim.running_systems import RunningSystems, default_plugins
from gz_course.sim.gz.sim.sdf.description import Plugin, WorldDescription
from gz_course.sim.gz.sim.sdf.reader import read_world, read_world_file
from gz_course.sim.gz.sim.sdf.resources import FILES, Resources, find_world
from gz_course.sim.gz.sim.truth import Truth

if TYPE_CHECKING:
    from gz_course.sim.gz.transport import Node


class World:
    """One world: its description, its MuJoCo model and data, its systems and its clock.

    Not thread-safe: a world belongs to the thread that steps it; other threads use `requests`.
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

        `server_plugins` are systems of the world that its file does not name. `resources` opens the files of models
        that are created later.
        """
        self.description = description
        self.diagnostics = diagnostics
        self.resources = resources
        self.seed = seed
        self.render_engine = check_engine(render_engine)
        """The render engine of the cameras; `rendering/renderer.py` has the names."""
        self.node: Node | None = None
        self.iterations = 0
        self.dropped_commands: dict[str, int] = {}
        """The number of commands dropped because they were not finite, by topic."""
        self.entities = Entities(description)
        """The entity ids of the world and its parts."""
        self.requests = Requests()
        """The queue of functions that other threads pass to the stepping thread."""
        if not 0.0 <= initial_sim_time <= 1e9:
            raise SimError(f"initial_sim_time must be between 0 and 1e9 seconds, got {initial_sim_time}")
        self._initial_ns = self._origin_ns = round(initial_sim_time * 1e9)
        self._info = UpdateInfo(description.step_size_ns * 1e-9)
        self.truth = Truth(description)
        """The true poses and velocities of models and links."""
        self.editor = Editor(self)
        """The methods that change the world between two steps."""
        self.systems = RunningSystems(self)
        """The running systems, in the order in which they are called."""
        if not description.plugins:
            description.plugins = default_plugins(description.element)
        self.systems.add_world((*description.plugins, *server_plugins))
        for model in description.models:
            self.systems.add(model)
        self._told: set[frozenset[str]] = set()
        self._build()
        self._bind()
        self.systems.start()
        self.systems.check_world()
        for model in description.models:
            self.systems.check_sensors(model)
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
        lenient: bool = False,
        server_plugins: Sequence[Plugin] = (),
    ) -> World:
        """Load a world by path, by name in GZ_SIM_RESOURCE_PATH, or by the name of a built-in world.

        With `strict` every warning is an error; with `lenient` wrong parameters of plugins cause warnings. Raises
        `SdfError` with file and line, `ResourceError` if there is no such file.
        """
        diagnostics = Diagnostics(strict=strict, lenient=lenient)
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
        """Load a world from SDF text; messages call it `file_name`."""
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
    def name(self) -> str:
        """Return the world's name in its SDF file."""
        return self.description.name

    @property
    def topic(self) -> str:
        """Return the prefix of the world's topics and services: `/world/NAME`, with underscores for blanks."""
        return valid_topic(f"/world/{self.name}")

    @property
    def step_size_ns(self) -> int:
        """Length of a step [ns]."""
        return self.description.step_size_ns

    @property
    def sim_time_ns(self) -> int:
        """Simulated time [ns], an exact integer: the number of steps times the step size."""
        return self._origin_ns + self.iterations * self.description.step_size_ns

    def model_names(self, *, static: bool = False) -> list[str]:
        """Return the names of the models; see `Truth.model_names`."""
        return self.truth.model_names(static=static)

    @property
    def warnings(self) -> list[str]:
        """Return all warnings about this world, one sentence each."""
        return self.diagnostics.warnings

    def _build(self, before: tuple[mujoco.MjModel, mujoco.MjData] | None = None) -> None:
        """Build MuJoCo's model, with its state at time zero or that of `before` where both name the same.

        The present ones are kept if MuJoCo rejects the model.
        """
        spec = build_spec(self.description, self.systems.servos, self.diagnostics)
        welds.add_welds(spec, self.description, self.systems.welds)
        hear_warnings()
        model, data = self._compile(spec, before)
        found = overlaps.find(model, data)
        if found:
            self._tell_overlaps(found)
            overlaps.add_pairs(spec, model, data, found)
            model, data = self._compile(spec, before)
        self.model, self.data = model, data
        self._warned = data.warning.number  # a view
        self._overlaps = overlaps.Overlaps(model, found)
        self._limits = JointLimits(model, data, self.description.models, self.systems.servos)
        self._fast = FastBodies(model, data)
        self.truth.bind(model, data)

    def _compile(
        self, spec: mujoco.MjSpec, before: tuple[mujoco.MjModel, mujoco.MjData] | None
    ) -> tuple[mujoco.MjModel, mujoco.MjData]:
        model, data = compile_world(spec, self.description, self.diagnostics)
        integrator.choose(model)
        sleeping.allow(model, data, self.description)
        mujoco.mj_forward(model, data)
        if before is not None:
            copy_state(*before, model, data)
        return model, data

    def _tell_overlaps(self, found: list[overlaps.Overlap]) -> None:
        for one, other, depth in found:
            if frozenset((one, other)) not in self._told:
                self._told.add(frozenset((one, other)))
                text = f"'{one}' and '{other}' are {depth:.3g} m inside each other; they are pushed apart slowly, "
                self.diagnostics.doubt("", f"{text}at {overlaps.FASTEST:g} m/s at most; place them apart")

    def rebuild(self) -> None:
        """Rebuild MuJoCo's model from the changed description; the state of unchanged entities is kept exactly."""
        self._build((self.model, self.data))
        self._bind()

    def _bind(self) -> None:
        """Connect the systems with the new model, and the limits of joints with the gains that the systems set."""
        self.systems.bind()
        self._limits.bind(self.model)

    def part_overlaps(self) -> None:
        """Let bodies that were just moved into each other come apart slowly; nothing else changes."""
        probe = mujoco.MjData(self.model)
        probe.qpos[:] = self.data.qpos
        mujoco.mj_kinematics(self.model, probe)
        mujoco.mj_comPos(self.model, probe)
        mujoco.mj_collision(self.model, probe)
        found = overlaps.find(self.model, probe)
        if found and not self._overlaps.soften(found):
            self.rebuild()

    def continue_from(self, sim_time_ns: int) -> None:
        """Continue at a simulated time [ns] with the step size of the changed description."""
        self._origin_ns = sim_time_ns - self.iterations * self.step_size_ns
        self._info.dt = self.step_size_ns * 1e-9

    def attach(self, node: Node | None) -> None:
        """Give every system a node of its own with the options of `node`, and let it subscribe and advertise.

        A world can be attached once; `close` closes the nodes.
        """
        if node is None or node is self.node:
            return
        if self.node is not None:
            raise SimError(f"world '{self.name}' is already attached to a node; load it again for another one")
        self.node = node
        with self.diagnostics.refusing():
            self.systems.connect(node)

    def close(self) -> None:
        """Close the nodes of all systems, with their publishers, subscriptions and services."""
        self.systems.close()

    def step(self, n: int = 1, ended: Callable[[], bool] | None = None) -> int:
        """Run `n` physics steps with all systems; queued requests of other threads run before each step.

        Steps in which no system has anything to do are physics alone. Stop before the next step if `ended()` is true
        after such requests. Return how many steps have run. Raises `SimError` with the name of the body if the physics
        becomes unstable.
        """
        requests, info, systems, truth = self.requests, self._info, self.systems, self.truth
        in_step = partial(systems.in_step, info)
        done, waiting = 0, requests.waiting
        requests.own()
        while done < n:
            if waiting:
                requests.serve()
                if ended is not None and ended():
                    break
            model, data, colliding = self.model, self.data, self._overlaps
            pre_updates, in_steps, post_updates = systems.pre_updates, systems.in_steps, systems.post_updates
            samples = systems.samples
            advance = self._limits.advance if self._limits.active else mujoco.mj_step
            watch = self._fast.watch if self._fast.active else None
            origin_ns, step_ns = self._origin_ns, self.description.step_size_ns
            requests.enter_step()
            try:
                while True:  # at least one step between two calls of serve()
                    info.sim_time_ns = origin_ns + self.iterations * step_ns
                    alone, rested = (0 if colliding.active else systems.steps_at_rest(info, n - done)), 0
                    while rested < alone and not (rested and waiting):
                        if watch is not None:
                            watch()
                        advance(model, data)
                        for sample in samples:
                            sample()
                        rested += 1
                    done += rested
                    self.iterations = iterations = self.iterations + rested
                    truth.stale = True
                    if done >= n or (rested and waiting):
                        break
                    done += 1
                    self.iterations = iterations = iterations + 1
                    info.iterations = iterations
                    info.sim_time_ns = origin_ns + iterations * step_ns
                    for pre_update in pre_updates:
                        pre_update(info)
                    if watch is not None:
                        watch()
                    if in_steps:
                        self._limits.advance(model, data, in_step)
                    else:
                        advance(model, data)
                    if colliding.active:
                        colliding.relax(data)
                    truth.stale = True  # a system may have refreshed the poses before the step
                    for sample in samples:
                        sample()
                    for post_update in post_updates:
                        post_update(info)
                    if waiting or done >= n:
                        break
            finally:
                requests.leave_step()
            if any(map(self._warned.item, UNSTABLE)):
                raise SimError(why_unstable(self.description, model, data, self.sim_time_ns))
        return done

    def paused_update(self) -> None:
        """Call `paused_update` of the systems that publish while the world is paused."""
        info = self._info
        info.iterations, info.sim_time_ns = self.iterations, self.sim_time_ns
        for hook in self.systems.paused_updates:
            hook(info)

    def reset(self, *, time_only: bool = False) -> None:
        """Reset to the start; every topic then carries the same bytes as in the first run.

        Spawned models are removed; removed and changed ones are restored. With `time_only` the clock and the systems
        are reset, but all bodies keep their positions and velocities.
        """
        self.requests.refuse_inside_step("be reset")
        self.iterations, self._origin_ns = 0, self._initial_ns
        if time_only:
            self.data.time = 0.0
        else:
            self._reset_state()
        self.truth.stale = True
        self._info.dt = self.step_size_ns * 1e-9
        self.systems.start()

    def _reset_state(self) -> None:
        was = list(self.description.models)
        changed = self.editor.restore()
        now = self.description.models
        self.entities.restart(self.description)
        for model in was:
            if not any(model is each for each in now):
                self.systems.remove(model)
        for model in now:
            if not any(model is each for each in was):
                self.systems.add(model)
        self.truth.models = {model.name: model for model in now}
        if changed:
            self._build()
            self._bind()
            self.systems.connect_new()
        else:
            self._overlaps.restart()
            mujoco.mj_resetData(self.model, self.data)
            mujoco.mj_forward(self.model, self.data)

    def drop_command(self, topic: str, what: str) -> None:
        """Count a command that was refused because it is not finite; warn at the first one of each topic."""
        count = self.dropped_commands.get(topic, 0) + 1
        self.dropped_commands[topic] = count
        if count == 1:
            self.diagnostics.warn(
                "",
                f"a command on {topic} was dropped because it is not finite ({what}); check for division by zero",
            )
