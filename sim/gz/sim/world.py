"""A simulated world as a library: load an SDF file, step it, ask for the truth.

No transport is needed (`World.load("lidar_room.sdf").step(1000)`); with a node attached the world's systems
take commands and publish. `World.load` reads (`gz.sim.sdf`), builds (`gz.sim.physics`), starts the systems
(`gz.sim.systems`); every `step` runs pre_update of all systems, one MuJoCo step, post_update of all systems.
Same file, seed and commands: same bytes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from gz.sim.entities import Entities
from gz.sim.errors import LOG, Diagnostics, SimError, nearest
from gz.sim.physics.builder import build_spec, scoped
from gz.sim.physics.servos import JointServo
from gz.sim.pose import Pose, Velocity, rotate
from gz.sim.sdf.description import Link, Model, Plugin, Sensor, WorldDescription
from gz.sim.sdf.reader import read_world, read_world_file
from gz.sim.sdf.resources import find_world
from gz.sim.sensors.registry import KNOWN_TYPES, sensor_types
from gz.sim.systems.registry import System, UpdateInfo, find_system, system_name, systems
from gz.sim.visuals import VisualShape, visual_shapes

if TYPE_CHECKING:
    from gz.transport import Node


_UNSTABLE = tuple(
    int(kind)
    for kind in (
        mujoco.mjtWarning.mjWARN_BADQPOS,
        mujoco.mjtWarning.mjWARN_BADQVEL,
        mujoco.mjtWarning.mjWARN_BADQACC,
        mujoco.mjtWarning.mjWARN_BADCTRL,
    )
)


@dataclass(frozen=True, slots=True)
class JointAddress:
    """Where a joint lives in MuJoCo's arrays: `position` in qpos, `velocity` in qvel, `control` in ctrl (-1:
    no servo).
    """

    position: int
    velocity: int
    control: int


class World:
    """One world: its description, its MuJoCo model and data, its systems and its clock."""

    def __init__(
        self,
        description: WorldDescription,
        diagnostics: Diagnostics,
        *,
        seed: int = 0,
        node: Node | None = None,
    ) -> None:
        """Build and start a world from its description; use `World.load` or `World.from_string`."""
        self.description = description
        self.diagnostics = diagnostics
        self.seed = seed
        self.node: Node | None = None
        self.step_size_ns = description.step_size_ns
        self.iterations = 0
        self.dropped_commands: dict[str, int] = {}
        """How many commands were refused because they were not finite, by topic."""
        self.entities = Entities(description)
        """The numbers of all entities."""
        self._info = UpdateInfo(description.step_size_ns * 1e-9)
        self._models = {model.name: model for model in description.models}
        self._build()
        self.systems: list[System] = []
        self._nodes: list[Node] = []
        self._start_systems()
        self._pre_updates = self._hooks("pre_update")
        self._post_updates = self._hooks("post_update")
        if node is not None:
            self.attach(node)

    @classmethod
    def load(cls, path_or_name: str | Path, *, seed: int = 0, node: Node | None = None) -> World:
        """Load a world by path, by name in GZ_SIM_RESOURCE_PATH, or built in; raise `SdfError` saying where
        and why.
        """
        diagnostics = Diagnostics()
        description = read_world_file(find_world(path_or_name), diagnostics)
        return cls(description, diagnostics, seed=seed, node=node)

    @classmethod
    def from_string(cls, sdf: str, *, seed: int = 0, file_name: str = "<string>", node: Node | None = None) -> World:
        """Load a world from SDF text; `file_name` stands for it in messages."""
        diagnostics = Diagnostics()
        return cls(read_world(sdf, file_name, diagnostics), diagnostics, seed=seed, node=node)

    @property
    def name(self) -> str:
        """The world's name in its SDF file."""
        return self.description.name

    @property
    def sim_time_ns(self) -> int:
        """Simulated time in nanoseconds: steps done times step size, exact."""
        return self.iterations * self.step_size_ns

    @property
    def warnings(self) -> list[str]:
        """Everything this world was warned about, one sentence each."""
        return self.diagnostics.warnings

    def _choose_systems(self) -> dict[str, list[JointServo]]:
        """Find the class of every plugin; return the joints they drive, by model."""
        self._chosen: list[tuple[type[System], Model | None, Plugin]] = []
        servos: dict[str, list[JointServo]] = {}
        for plugin in self.description.plugins:
            found = find_system(plugin, self.diagnostics)
            if found is not None:
                self._chosen.append((found, None, plugin))
        for model in self.description.models:
            taken = servos.setdefault(model.name, [])
            for plugin in model.plugins:
                found = find_system(plugin, self.diagnostics)
                if found is None:
                    continue
                driven = found.servos(model, plugin)
                if driven and model.static:
                    text = f"model '{model.name}' is static, so its system {found.name} cannot move it"
                    self.diagnostics.warn(plugin.element.where, text)
                    continue
                names = {servo.joint for servo in taken}
                taken.extend(servo for servo in driven if servo.joint not in names)
                self._chosen.append((found, model, plugin))
        return servos

    def _build(self) -> None:
        servos = self._choose_systems()
        spec = build_spec(self.description, servos, self.diagnostics)
        mujoco.set_mju_user_warning(lambda text: LOG.warning("physics: %s", text))
        try:
            self.model = spec.compile()
        except (ValueError, mujoco.FatalError) as error:
            reason = " ".join(str(error).split())
            raise self.description.element.error(f"the physics engine refuses this world: {reason}") from None
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        self._refreshed = 0
        # Per moving model: the body of its canonical link, and the model frame seen from it.
        self._canonical: dict[str, tuple[int, Pose]] = {}
        for model in self.description.models:
            canonical = model.link(model.canonical_link)
            if canonical is not None and not model.static:
                body = int(self.model.body(scoped(model, canonical.name)).id)
                self._canonical[model.name] = (body, canonical.pose.inverse())

    def _start_systems(self) -> None:
        for found, model, plugin in self._chosen:
            made = found()
            made.configure(self, model, plugin)
            made.bind()
            made.start()
            self.systems.append(made)
        names = {made.name for made in self.systems}
        wanted = {system_name(plugin) for plugin in self.description.plugins}
        if wanted and "Physics" not in wanted:
            self.diagnostics.warn(
                self.description.element.where,
                f"world '{self.name}' loads plugins but not Physics, so in Gazebo nothing would move; "
                "physics runs "
                "here, add <plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>",
            )
        for model in self.description.models:
            for sensor in model.sensors():
                self._check_sensor(sensor, names)

    def _check_sensor(self, sensor: Sensor, running: set[str]) -> None:
        """Say so when nothing will run a sensor."""
        types, kind = sensor_types(), sensor.kind
        if kind in types:
            system = types[kind].runs_in
            if system in running:
                return
            text = (
                f"sensor '{sensor.name}' stays silent because the world does not load the {system} system; add "
                f"<plugin filename='{systems()[system].filename}' name='gz::sim::systems::{system}'/> to <world>"
            )
        elif kind in KNOWN_TYPES:
            text = f"sensor type '{kind}' is not simulated here, sensor '{sensor.name}' stays silent"
        else:
            hint = nearest(kind, types, listing="types that run here are")
            text = f"sensor '{sensor.name}' has type '{kind}', which is not known; {hint}"
        self.diagnostics.warn(sensor.element.where, text)

    def _hooks(self, hook: str) -> list[Callable[[UpdateInfo], None]]:
        return [getattr(each, hook) for each in self.systems if getattr(type(each), hook) is not getattr(System, hook)]

    def attach(self, node: Node | None) -> None:
        """Let every system subscribe and advertise on a node of its own that has the options of `node`.

        A world is attached once at most; `close` ends what it opened.
        """
        if node is None or node is self.node:
            return
        if self.node is not None:
            raise SimError(f"world '{self.name}' is already attached to a node; load it again for another one")
        self.node = node
        for each in self.systems:
            own = type(node)(node.options)
            self._nodes.append(own)
            each.connect(own)

    def close(self) -> None:
        """End everything the systems advertised and subscribed to."""
        for each in self.systems:
            each.close()
        for node in self._nodes:
            node.close()
        self._nodes.clear()

    def step(self, n: int = 1) -> None:
        """Run `n` physics steps with all systems; raise `SimError` when the physics came out not finite."""
        model, data, info, step_ns = self.model, self.data, self._info, self.step_size_ns
        pre_updates, post_updates, advance = self._pre_updates, self._post_updates, mujoco.mj_step
        for _ in range(n):
            self.iterations = iterations = self.iterations + 1
            info.iterations = iterations
            info.sim_time_ns = iterations * step_ns
            for pre_update in pre_updates:
                pre_update(info)
            advance(model, data)
            for post_update in post_updates:
                post_update(info)
        if any(data.warning.number[kind] for kind in _UNSTABLE):
            raise SimError(
                f"the physics of world '{self.name}' became unstable before {self.sim_time_ns * 1e-9:.3f} s; "
                "look for bodies that start inside each other, tiny masses or inertias, or a smaller "
                "max_step_size"
            )

    def refresh(self) -> None:
        """Bring MuJoCo's world poses (`data.xpos`, `site_xpos`, ...) up to the present; a step leaves them
        one step behind.
        """
        if self._refreshed != self.iterations:
            mujoco.mj_kinematics(self.model, self.data)
            self._refreshed = self.iterations

    def model_names(self, *, static: bool = False) -> list[str]:
        """Return the names of the models that can move, in file order; with `static` those that cannot come
        after.
        """
        moving = [model.name for model in self.description.models if not model.static]
        return moving + [model.name for model in self.description.models if model.static] if static else moving

    def pose(self, model: str) -> Pose:
        """Return where the model's frame is now, in the world frame; raise `SimError` for an unknown
        model.
        """
        found = self._model(model)
        if found.static:
            return found.pose
        body, link_model = self._canonical[model]
        self.refresh()
        return Pose(self.data.xpos[body], self.data.xquat[body]) * link_model

    def link_pose(self, model: str, link: str) -> Pose:
        """Return where a link's frame is now, in the world frame; raise `SimError` for an unknown model or
        link.
        """
        found = self._model(model)
        part = found.link(link)
        if part is None:
            names = [each.name for each in found.links]
            raise SimError(f"model '{model}' has no link '{link}'; {nearest(link, names, listing='its links are')}")
        return found.pose * part.pose if found.static else self._link_pose(found, part)

    def velocity(self, model: str) -> Velocity:
        """Return the velocity of the model's frame (m/s, rad/s, world axes); raise `SimError` for an unknown
        model.
        """
        found = self._model(model)
        if found.static:
            return Velocity(np.zeros(3), np.zeros(3))
        self.refresh()
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_comVel(self.model, self.data)
        body, link_model = self._canonical[model]
        both = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, body, both, 0)
        angular, linear = both[:3].copy(), both[3:].copy()
        offset = rotate(self.data.xquat[body], link_model.position)
        lever = np.zeros(3)
        mujoco.mju_cross(lever, angular, offset)
        return Velocity(linear + lever, angular)

    def geometry(self) -> list[VisualShape]:
        """Return every visible shape of the world, fixed to its link."""
        return visual_shapes(self.description)

    def joint_address(self, model: Model, joint: str) -> JointAddress:
        """Return where a joint (scoped name) of a moving model lives in MuJoCo's arrays."""
        name = scoped(model, joint)
        found = self.model.joint(name)
        control = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, name)
        return JointAddress(int(found.qposadr[0]), int(found.dofadr[0]), control)

    def drop_command(self, topic: str, what: str) -> None:
        """Count a command that was refused because it is not finite; say so the first time for each topic."""
        count = self.dropped_commands.get(topic, 0) + 1
        self.dropped_commands[topic] = count
        if count == 1:
            self.diagnostics.warn(
                "",
                f"a command on {topic} was dropped because it is not finite ({what}); check for division by zero",
            )

    def _model(self, name: str) -> Model:
        found = self._models.get(name)
        if found is None:
            hint = nearest(name, self._models, listing="its models are")
            raise SimError(f"world '{self.name}' has no model '{name}'; {hint}")
        return found

    def _link_pose(self, model: Model, link: Link) -> Pose:
        self.refresh()
        body = self.model.body(scoped(model, link.name))
        return Pose(self.data.xpos[body.id], self.data.xquat[body.id])
