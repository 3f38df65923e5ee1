"""TouchPlugin: reports once that a model has touched a target for some time without a break; a plugin of a model.

After every step it checks the collisions of the model's contact sensors. After a message on `/NAMESPACE/touched` the
plugin is disabled until a call of the service `/NAMESPACE/enable`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/touch_plugin/TouchPlugin.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.physics.contacts import CollisionGeoms, CollisionPath, touching
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system, system_name
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.requests import logged
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


@system("TouchPlugin", "gz-sim-touchplugin-system")
class TouchPlugin(System):
    """Parameters: `<target>` is part of the scoped names of the collisions to touch, `<time>` [s] the shortest
    duration, `<namespace>` that of the topic and the service, `<enabled>` the initial state.
    """

    parameters = frozenset(("target", "time", "namespace", "enabled"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters. Raises SdfError if one is missing or the plugin is not in a model.

        Warns if the model has no contact sensor or no Contact system runs it, because no touch is then detected.
        """
        element = plugin.element
        if model is None:
            raise element.error("TouchPlugin must stand in a <model>")
        for tag in ("target", "time", "namespace"):
            if not element.text_of(tag):
                raise element.error(f"TouchPlugin needs <{tag}>")
        self._world, self._model = world, model
        self._target = element.text_of("target")
        self._namespace = valid_topic(element.text_of("namespace"))
        seconds = element.number("time", 0.0)
        if not 0.0 <= seconds < 1e9:
            raise element.error(f"<time> of TouchPlugin must be seconds from 0 on, up to 1e9, got {seconds}")
        self._time_ns = round(seconds * 1e9)
        self._enabled_at_start = self._enabled = element.flag("enabled", False)
        self._since_ns = -1
        self._publisher: Any = None
        # Gazebo uses the model's own links only, not those of nested models.
        scope = f"{plugin.scope}::" if plugin.scope else ""
        self._feeling: list[CollisionPath] = []
        for link in model.links:
            if link.name.startswith(scope) and "::" not in link.name[len(scope) :]:
                contacts = [sensor.element.find("contact") for sensor in link.sensors if sensor.kind == "contact"]
                named = {
                    child.text for contact in contacts if contact is not None for child in contact.all("collision")
                }
                self._feeling += [(model.name, link.name, part.name) for part in link.collisions if part.name in named]
        where = element.where
        if not self._feeling:
            text = f"TouchPlugin of model '{model.name}' never reports a touch: "
            world.diagnostics.warn(where, text + "no contact sensor of the model names one of its collisions")
        elif not any(system_name(each) == "Contact" for each in world.description.plugins):
            text = f"TouchPlugin of model '{model.name}' never reports a touch: the world does not load the Contact "
            world.diagnostics.warn(
                where,
                f"{text}system; add <plugin filename='gz-sim-contact-system' name='gz::sim::systems::Contact'/>",
            )
            self._feeling = []

    def bind(self) -> None:
        """Find the geoms of the sensors and of the target, including those of new models."""
        geoms = CollisionGeoms(self._world)
        self._geoms = {geom for path in self._feeling for geom in geoms.of(path)}
        world = self._world.name
        self._targets = {geom for geom, path in geoms.paths.items() if self._target in _gazebo_name(world, path)}

    def start(self) -> None:
        self.enable(self._enabled_at_start)

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.empty_pb2 import Empty

        service = f"{self._namespace}/enable"

        def serve(request: Boolean) -> Empty:
            self._world.requests.put(logged(lambda: self.enable(request.data), service))
            return Empty()

        self._type = Boolean
        self._publisher = node.advertise(f"{self._namespace}/touched", Boolean)
        node.advertise_service(service, Boolean, Empty, serve)

    def enable(self, on: bool) -> None:
        """Enable or disable the plugin; the duration of the touch starts at zero."""
        self._since_ns = -1
        self._enabled = on

    def post_update(self, info: UpdateInfo) -> None:
        if not self._enabled:
            return
        if not any(other in self._targets for _, _, other in touching(self._world, self._geoms)):
            self._since_ns = -1
            return
        if self._since_ns < 0:
            self._since_ns = info.sim_time_ns
        if info.sim_time_ns - self._since_ns > self._time_ns:
            self.enable(False)
            if self._publisher is not None:
                self._publisher.publish(self._type(data=True))


def _gazebo_name(world: str, path: CollisionPath) -> str:
    """Return a collision's scoped name with entity kinds, in which Gazebo searches for `<target>`."""
    model, link, collision = path
    *nested, own = link.split("::")
    models = "".join(f"/model/{name}" for name in (model, *nested))
    return f"world/{world}{models}/link/{own}/collision/{collision}"
