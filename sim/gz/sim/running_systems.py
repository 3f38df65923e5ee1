"""The systems of a world: their creation from plugins, configuration, connection to the transport and removal.

`World` calls `add` for the plugins of the world and of every model, `bind` after each build of MuJoCo's model and
`start` at time zero, and calls the collected hooks in every step. Every system has its own transport node, so that its
topics and services end with its model.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.physics.servos import JointServo
from gz_course.sim.gz.sim.physics.welds import WeldRequest
from gz_course.sim.gz.sim.plugins.sensor import NOT_SIMULATED, SensorBase, sensor_types
from gz_course.sim.gz.sim.plugins.sensor_system import SensorSystem
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, find_system, system_name, systems
from gz_course.sim.gz.sim.sdf.description import Model, Plugin, Sensor
from gz_course.sim.gz.sim.sdf.element import Element, without
from gz_course.sim.gz.sim.shared_topics import SharedTopics, Talker

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

Hook = Callable[[UpdateInfo], None]
MOST_AT_REST = 100
"""The largest number of steps without hooks, so that a command of another thread is not left waiting."""


@dataclass(eq=False)
class Running:
    """A system with its model (None: the world) and, once it is connected, its node."""

    system: System
    model: Model | None
    plugin: Plugin
    node: Node | None = None


class RunningSystems:
    """The systems of one world: those of the world first, then those of the models in file order."""

    def __init__(self, world: WorldAccess) -> None:
        self._world = world
        self._running: list[Running] = []
        self.servos: dict[str, list[JointServo]] = {}
        """The servos that systems have requested, by model."""
        self.welds: dict[str, list[WeldRequest]] = {}
        """The connections between models that systems have requested, by model."""
        self._options_of: Node | None = None
        self._shared_topics = SharedTopics(world.diagnostics)
        self.pre_updates: list[Hook] = []
        self.in_steps: list[Hook] = []
        self.post_updates: list[Hook] = []
        self.samples: list[Callable[[], None]] = []
        self._rests: list[Callable[[UpdateInfo], int]] | None = None
        self.paused_updates: list[Hook] = []

    def __iter__(self) -> Iterator[System]:
        """Yield all systems in the order in which they are called."""
        return (each.system for each in self._running)

    def __len__(self) -> int:
        return len(self._running)

    def sensors(self) -> Iterator[SensorBase]:
        return (sensor for system in self if isinstance(system, SensorSystem) for sensor in system.sensors)

    def add_world(self, plugins: Iterable[Plugin]) -> None:
        """Create and configure the systems of the world itself."""
        for plugin in plugins:
            found = find_system(plugin, self._world.diagnostics)
            if found is not None:
                self._add_plugin(found, None, plugin)

    def add(self, model: Model) -> list[Running]:
        """Create, configure and return the systems of a model.

        Raises SdfError for invalid parameters; then no system of the model is kept.
        """
        before = list(self._running)
        self.servos[model.name], self.welds[model.name] = [], []
        try:
            for plugin in model.plugins:
                found = find_system(plugin, self._world.diagnostics)
                if found is not None:
                    self._add_plugin(found, model, plugin)
        except Exception:
            self._running = before
            del self.servos[model.name], self.welds[model.name]
            raise
        return [each for each in self._running if each not in before]

    def _add_plugin(self, found: type[System], model: Model | None, plugin: Plugin) -> None:
        """Create and configure the system of a plugin.

        Raises SdfError for invalid parameters. If the diagnostics are lenient, each is replaced by its default, or the
        system is left out where that is not enough, with a warning.
        """
        diagnostics, told = self._world.diagnostics, list[str]()
        lenient, kept = diagnostics.lenient and not diagnostics.strict, plugin
        while True:
            try:
                self._make(found, model, kept)
                break
            except SdfError as error:
                fault = parameter_at_fault(kept.element, error) if lenient else None
                if not lenient:
                    raise
                if fault is None:
                    told = [f"{told[0] if told else error}; system {found.name} is left out"]
                    break
                told.append(str(error))
                kept = replace(kept, element=without(kept.element, fault))
        for text in told:
            diagnostics.warn("", text if text.endswith("left out") else f"{text}; its default is used")

    def _make(self, found: type[System], model: Model | None, plugin: Plugin) -> None:
        diagnostics = self._world.diagnostics
        driven = found.servos(model, plugin) if model is not None else []
        if model is not None and driven and model.static:
            text = f"model '{model.name}' is static, so its system {found.name} cannot move it"
            diagnostics.warn(plugin.element.where, text)
            return
        welded = found.welds(model, plugin) if model is not None else []
        first = next((each for each in self._running if type(each.system) is found), None)
        if found.once and first is not None:
            text = f"{found.name} runs already (see {first.plugin.element.where}) and serves the whole world, "
            diagnostics.warn(plugin.element.where, f"{text}this second one is ignored; remove it")
            return
        made = found()
        made.configure(self._world, model, plugin)
        self._running.append(Running(made, model, plugin))
        if model is not None:
            taken, welds = self.servos[model.name], self.welds[model.name]
            for servo in driven:
                if all(servo.actuator != other.actuator for other in taken):
                    taken.append(servo)
            known = {weld.name for weld in welds}
            welds += [weld for weld in welded if weld.name not in known]

    def bind(self) -> None:
        """Bind all systems to MuJoCo's model, and collect their hooks in order."""
        order = {id(model): number for number, model in enumerate(self._world.description.models)}
        self._running.sort(key=lambda each: -1 if each.model is None else order.get(id(each.model), len(order)))
        for each in self._running:
            each.system.bind()
        self.pre_updates = self._hooks("pre_update")
        if any(each.pushes for each in self):
            self.pre_updates.insert(0, self._clear_forces)
        self.in_steps = self._hooks("in_step")
        self.post_updates = self._hooks("post_update")
        self.paused_updates = self._hooks("paused_update")
        self.samples = [each.sampler() for each in self if _overrides(each, "sampler")]
        stepped = [each for each in self if _overrides(each, "pre_update") or _overrides(each, "post_update")]
        able = not self.in_steps and all(_overrides(each, "rests_until") and not each.pushes for each in stepped)
        self._rests = [each.rests_until for each in stepped] if able else None

    def steps_at_rest(self, info: UpdateInfo, most: int) -> int:
        """Return in how many of the next steps, at most `most`, no system has anything to do."""
        if self._rests is None:
            return 0
        now, step_ns = info.sim_time_ns, self._world.step_size_ns
        most = min(most, MOST_AT_REST)
        until = now + (most + 1) * step_ns
        for rests_until in self._rests:
            until = min(until, rests_until(info))
        return max(0, (until - now - 1) // step_ns)

    def in_step(self, info: UpdateInfo) -> None:
        """Call `in_step` of the systems that act between the two halves of a step."""
        for hook in self.in_steps:
            hook(info)

    def _clear_forces(self, info: UpdateInfo) -> None:
        self._world.data.xfrc_applied[:] = 0.0

    def _hooks(self, hook: str) -> list[Hook]:
        return [getattr(each, hook) for each in self if _overrides(each, hook)]

    def start(self, only: Iterable[Running] | None = None) -> None:
        """Initialize all systems, or those in `only`, from the present state."""
        for each in self._running if only is None else only:
            each.system.start()

    def connect(self, node: Node) -> None:
        """Connect every system, including those added later, by a node with the options of `node`."""
        self._options_of = node
        self.connect_new()

    def connect_new(self) -> None:
        """Connect the systems that have no node yet, if the world is connected."""
        if self._options_of is None:
            return
        for each in self._running:
            if each.node is None:
                each.node = type(self._options_of)(self._options_of.options)
                each.system.connect(each.node)
        self._shared_topics.check(self._talkers())

    def _talkers(self) -> Iterator[Talker]:
        """Yield all connected systems and sensors in the order in which they were added."""
        for each in self._running:
            system, name = each.system, each.model.name if each.model is not None else ""
            if isinstance(system, SensorSystem):
                for sensor, node in system.connected():
                    made = sensor.description
                    shown = f"sensor '{made.name}' of model '{made.model}'"
                    yield Talker(system.name, shown, made.model, made.element, node, system.joins_topics)
            elif each.node is not None:
                shown = f"{system.name} of model '{name}'" if name else system.name
                joins = system.joins_topics or not name
                yield Talker(system.name, shown, name, each.plugin.element, each.node, joins)

    def remove(self, model: Model) -> None:
        """Close the systems of a model and their nodes."""
        gone = [each for each in self._running if each.model is model]
        self._running = [each for each in self._running if each.model is not model]
        self.servos.pop(model.name, None)
        self.welds.pop(model.name, None)
        for each in gone:
            self._end(each)

    def close(self) -> None:
        """Close the nodes of all systems; the systems themselves remain."""
        for each in self._running:
            self._end(each)
            each.node = None

    @staticmethod
    def _end(running: Running) -> None:
        running.system.close()
        if running.node is not None:
            running.node.close()

    def check_world(self) -> None:
        """Warn about a world that has plugins but not Physics, and about wind that moves nothing."""
        description = self._world.description
        wanted = {system_name(plugin) for plugin in description.plugins}
        if any(description.wind) and "WindEffects" not in wanted:
            self._world.diagnostics.warn(
                (description.element.find("wind") or description.element).where,
                "<wind> moves nothing because the world does not load the WindEffects system; add "
                "<plugin filename='gz-sim-wind-effects-system' name='gz::sim::systems::WindEffects'/>",
            )
        if wanted and "Physics" not in wanted:
            self._world.diagnostics.warn(
                description.element.where,
                f"world '{description.name}' loads plugins but not Physics, so in Gazebo nothing would move; "
                "physics runs here, add <plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>",
            )

    def check_sensors(self, model: Model) -> None:
        """Warn about each sensor of a model that is not run by a system."""
        running = {each.name for each in self}
        for sensor in model.sensors():
            text = _why_silent(sensor, running)
            if text:
                self._world.diagnostics.warn(sensor.element.where, text)


def _overrides(system: System, hook: str) -> bool:
    return getattr(type(system), hook) is not getattr(System, hook)


def parameter_at_fault(plugin: Element, error: SdfError) -> Element | None:
    """Return the element below a plugin that an error is about, or None if it is about something else."""
    element = error.element
    if element is None or not any(each is element for each in plugin.below()):
        return None
    if element is not plugin:
        return element
    named = (plugin.find(tag) for tag in re.findall(r"<(\w+)>", str(error)))
    return next((each for each in named if each is not None), None)


def _why_silent(sensor: Sensor, running: set[str]) -> str:
    types, kind = sensor_types(), sensor.kind
    if kind in types:
        system = types[kind].runs_in
        if system in running:
            return ""
        return (
            f"sensor '{sensor.name}' stays silent because the world does not load the {system} system; add "
            f"<plugin filename='{systems()[system].filename}' name='gz::sim::systems::{system}'/> to <world>"
        )
    if kind in NOT_SIMULATED:
        return f"sensor type '{kind}' is not simulated here, sensor '{sensor.name}' stays silent"
    hint = did_you_mean(kind, types, listing="types that run here are")
    return f"sensor '{sensor.name}' has type '{kind}', which is not known{hint}"


def default_plugins(world: Element) -> list[Plugin]:
    """Return Gazebo's systems for a world without plugins: Physics, UserCommands and SceneBroadcaster."""
    made: list[Plugin] = []
    for name, filename in (
        ("Physics", "gz-sim-physics-system"),
        ("UserCommands", "gz-sim-user-commands-system"),
        ("SceneBroadcaster", "gz-sim-scene-broadcaster-system"),
    ):
        attributes = {"name": f"gz::sim::systems::{name}", "filename": filename}
        element = Element("plugin", dict(attributes), file=world.file, line=world.line)
        made.append(Plugin(attributes["name"], filename, element))
    return made
