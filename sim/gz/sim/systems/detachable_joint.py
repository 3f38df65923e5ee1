"""DetachableJoint: a rigid connection from a link of this model to one of another, which can be made and cut.

`gz.msgs.Empty` on `/model/M/detachable_joint/detach` cuts it, on `.../attach` makes it again at the present pose;
`gz.msgs.StringMsg` on `/model/CHILD/detachable_joint/state` says `attached` or `detached` at each change.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/detachable_joint/DetachableJoint.cc
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.physics.welds import WeldRequest, find_weld
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.requests import logged
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_OWN_MODEL = "__model__"


@system("DetachableJoint", "gz-sim-detachable-joint-system")
class DetachableJoint(System):
    """Attached from the start unless `<initial_attach>` is false; a missing child is told unless that is suppressed."""

    parameters = frozenset(
        (
            "parent_link",
            "child_model",
            "child_link",
            "topic",
            "detach_topic",
            "attach_topic",
            "output_topic",
            "initial_attach",
            "suppress_child_warning",
        )
    )

    @classmethod
    def welds(cls, model: Model, plugin: Plugin) -> list[WeldRequest]:
        """Return the pair of links. Raises SdfError if a parameter is missing or the parent does not exist."""
        element = plugin.element
        for tag in ("parent_link", "child_model", "child_link"):
            if not element.text_of(tag):
                raise element.error(f"DetachableJoint needs a <{tag}>, none was found")
        scope = f"{model.name}::{plugin.scope}::" if plugin.scope else f"{model.name}::"
        parent = scope + element.text_of("parent_link")
        if model.link(parent.removeprefix(f"{model.name}::")) is None:
            names = ", ".join(link.name for link in model.links)
            text = f"DetachableJoint's <parent_link> '{element.text_of('parent_link')}' is no link of model "
            raise element.error(f"{text}'{model.name}'; its links are: {names}")
        child, link = element.text_of("child_model"), element.text_of("child_link")
        owners = [scope] if child == _OWN_MODEL else [f"{child}::", f"{scope}{child}::"]
        children = tuple(owner + link for owner in owners)
        return [WeldRequest(f"{parent}#weld {child}::{link}", parent, children)]

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the topics and the initial state. Raises SdfError if the plugin is not in a model."""
        element = plugin.element
        scope = ModelScope(world, model, plugin, self.name)
        self._world, self._where = world, element.where
        self._weld_name = self.welds(scope.model, plugin)[0].name
        self._child = f"{element.text_of('child_model')}::{element.text_of('child_link')}"
        stem = f"/model/{scope.name}/detachable_joint"
        cut = [element.text_of(tag) for tag in ("detach_topic", "topic")]
        self.detach_topic = valid_topic(*filter(None, cut), f"{stem}/detach")
        self.attach_topic = valid_topic(*filter(None, [element.text_of("attach_topic")]), f"{stem}/attach")
        child = scope.name if element.text_of("child_model") == _OWN_MODEL else element.text_of("child_model")
        told = [element.text_of("output_topic")]
        self.state_topic = valid_topic(*filter(None, told), f"/model/{child}/detachable_joint/state")
        self._attached_at_start = element.flag("initial_attach", True)
        self._silent = element.flag("suppress_child_warning", False)
        self._pose: Pose | None = None
        self._publisher: Any = None

    def bind(self) -> None:
        """Find the constraint, and hold it again if the model was rebuilt."""
        self._weld = find_weld(self._world.model, self._weld_name)
        if self._weld is None:
            self._pose = None  # a child that comes back is attached where it is then
        elif self._pose is not None:
            self._weld.hold(self._world.data, self._pose)

    def start(self) -> None:
        self._pose = None
        self._wanted = self._attached_at_start
        if self._weld is not None:
            self._weld.let_go(self._world.data)

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

        self._type = StringMsg
        self._publisher = node.advertise(self.state_topic, StringMsg)
        for topic, wanted in ((self.detach_topic, False), (self.attach_topic, True)):
            node.subscribe(Empty, topic, partial(self._request, wanted, topic))

    def _request(self, wanted: bool, topic: str, _: Any) -> None:
        self._world.requests.put(logged(lambda: setattr(self, "_wanted", wanted), topic))

    @property
    def attached(self) -> bool:
        """Whether the links are connected."""
        return self._pose is not None

    def pre_update(self, info: UpdateInfo) -> None:
        """Make or cut the connection if that was asked for."""
        if self._wanted == self.attached:
            return
        if self._weld is None:
            if not self._silent:
                text = f"DetachableJoint finds no link '{self._child}' to attach; it is attached when there is one"
                self._world.diagnostics.warn_once(f"{self._where} child", self._where, text)
            return
        if self._wanted:
            self._world.truth.refresh()
            self._pose = self._weld.relative_pose(self._world.data)
            self._weld.hold(self._world.data, self._pose)
        else:
            self._pose = None
            self._weld.let_go(self._world.data)
        if self._publisher is not None:
            self._publisher.publish(self._type(data="attached" if self._wanted else "detached"))
