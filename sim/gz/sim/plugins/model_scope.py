"""The model that contains a `<plugin>`, top-level or nested: its name, joints, links and pose.

Nested models are flattened into their top model, whose parts carry the scope in their names (`arm::hand`). A
`ModelScope` gives a system the parts that Gazebo would find in the model that contains the plugin.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.pose import IDENTITY, Pose
from gz_course.sim.gz.sim.sdf.description import Joint, Link, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


class ModelScope:
    """The model that contains a plugin: `name` is its own name, `full_name` the scoped one, `topic` its path below the
    world, as in `/model/outer/model/inner`.
    """

    def __init__(self, world: WorldAccess, model: Model | None, plugin: Plugin, system: str) -> None:
        """Find the model of the plugin. Raises SdfError if there is none."""
        if model is None:
            raise plugin.element.error(f"{system} belongs inside a <model>, not directly in the <world>")
        self.world = world
        self.model = model
        self.system = system
        self._prefix = f"{plugin.scope}::" if plugin.scope else ""
        parts = [model.name, *(plugin.scope.split("::") if plugin.scope else ())]
        self.name = parts[-1]
        self.full_name = "::".join(parts)
        self.topic = "".join(f"/model/{part}" for part in parts)
        nested = next((each for each in model.nested if each.name == plugin.scope), None) if plugin.scope else None
        self._place = nested.pose if nested is not None else IDENTITY
        self._outer = plugin.scope.rpartition("::")[0] if plugin.scope else ""
        self.canonical_link = nested.canonical_link if nested is not None else model.canonical_link
        self.path = (model.name,) if nested is None else (model.name, plugin.scope)

    def scoped(self, name: str) -> str:
        """Return the name of a part in the lists of the top model."""
        return self._prefix + name

    def own_name(self, name: str) -> str:
        """Return the name of a part relative to this model."""
        return name.removeprefix(self._prefix)

    def joints(self) -> list[Joint]:
        """Return the joints of this model in file order, without those of nested models."""
        return [
            joint
            for joint in self.model.joints
            if joint.name.startswith(self._prefix) and "::" not in joint.name.removeprefix(self._prefix)
        ]

    def find_joints(self, element: Element, tag: str = "joint_name") -> list[Joint]:
        """Return the joints named by the children `tag`, also those of nested models (`arm::elbow`), each once.

        Warns about a name that no joint has.
        """
        found: list[Joint] = []
        for child in element.all(tag):
            joint = self.model.joint(self.scoped(child.text))
            if joint is None:
                self._warn_missing(child, "joint", self.model.joints)
            elif joint not in found:
                found.append(joint)
        return found

    def find_links(self, element: Element, tag: str = "link_name") -> list[Link]:
        """Return the links named by the children `tag`; warns about a name that no link has."""
        found: list[Link] = []
        for child in element.all(tag):
            link = self.model.link(self.scoped(child.text))
            if link is None:
                self._warn_missing(child, "link", self.model.links)
            else:
                found.append(link)
        return found

    def named_link(self, element: Element) -> Link | None:
        """Return the link named by `<link_name>`; None, with a warning, if no link has the name.

        Raises SdfError if there is no `<link_name>`.
        """
        if element.find("link_name") is None:
            raise element.error(f"{self.system} needs a <link_name>, none was found")
        return next(iter(self.find_links(element)), None)

    def _warn_missing(self, child: Element, kind: str, parts: Sequence[Joint | Link]) -> None:
        known = [self.own_name(part.name) for part in parts if part.name.startswith(self._prefix)]
        hint = did_you_mean(child.text, known, listing=f"its {kind}s are")
        text = f"{self.system}'s <{child.tag}> names {kind} '{child.text}', which model '{self.full_name}' "
        self.world.diagnostics.warn(child.where, f"{text}does not have, it is left out{hint}")

    def body(self, link: str) -> int:
        """Return MuJoCo's body id of a link (scoped name), -1 if the link is static."""
        name = scoped(self.model, link)
        return int(mujoco.mj_name2id(self.world.model, mujoco.mjtObj.mjOBJ_BODY, name))

    def link_to_frame(self) -> Pose:
        """Return the pose of this model's frame in its canonical link."""
        link = self.model.link(self.canonical_link)
        return link.pose.inverse() * self._place if link is not None else self._place

    def world_pose(self) -> Pose:
        """Return the pose of this model in the world frame."""
        if self.model.link(self.canonical_link) is None:
            return self.world.truth.pose(self.model.name) * self._place
        return self.world.truth.link_pose(self.model.name, self.canonical_link) * self.link_to_frame()

    def pose(self) -> Pose:
        """Return the pose of this model in its parent: the world or the enclosing model."""
        if not self._prefix:
            return self.world.truth.pose(self.model.name)
        outer = self.world.truth.pose(self.model.name)
        if self._outer:
            around = next(each for each in self.model.nested if each.name == self._outer)
            carrier = self.model.link(around.canonical_link)
            if carrier is not None:
                inside = carrier.pose.inverse() * around.pose
                outer = self.world.truth.link_pose(self.model.name, around.canonical_link) * inside
            else:
                outer = outer * around.pose
        return outer.inverse() * self.world_pose()

    def pose_in_floats(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return the position [m] and quaternion (wxyz) of `pose`."""
        if not self._prefix:
            return self.world.truth.pose_in_floats(self.model.name)
        pose = self.pose()
        return pose.position.tolist(), pose.quaternion.tolist()

    def entity(self, kind: str, name: str) -> int:
        """Return the entity id of a part of this model (scoped name), 0 if there is none."""
        return self.world.entities.number(kind, self.model.name, name)
