"""Contact sensor: the contacts of the named collisions of its link, as `gz.msgs.Contacts`.

The Contact system runs it. As in Gazebo it publishes at every step with a contact, regardless of `<update_rate>`, and
otherwise nothing; its topic is given in `<contact>`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/contact/Contact.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.contacts import CollisionGeoms, CollisionPath, ContactPoint, contact_points
from gz_course.sim.gz.sim.plugins.sensor import SensorBase, sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.description import Sensor

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

SDF_WORDS = {
    "sensor": "contact",
    "contact": "collision topic",
}

NO_TOPIC = "__default_topic__"


@sensor_type("contact")
class Contact(SensorBase):
    """Publishes one `Contact` with all points for each pair of collisions that touch."""

    runs_in = sensor_system("Contact", "gz-sim-contact-system")

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read `<contact>`. Raises SdfError if it is missing; warns about an unknown collision and a misplaced
        topic.
        """
        super().__init__(world, description)
        element = description.element
        contact = element.find("contact")
        if contact is None:
            text = f"contact sensor '{description.name}' has no <contact> element"
            raise element.error(f"{text}; add <contact><collision>NAME</collision></contact>")
        stated = contact.text_of("topic", NO_TOPIC)
        self.topic = self.default_topic if stated == NO_TOPIC else valid_topic(stated, self.default_topic)
        if stated == NO_TOPIC and element.find("topic") is not None:
            text = f"the <topic> of contact sensor '{description.name}' has no effect here, it must stand in <contact>"
            world.diagnostics.warn(element.where, f"{text}; the sensor publishes on {self.topic}")
        self.period_ns = 0
        model = next(each for each in world.description.models if each.name == description.model)
        link = model.link(description.link)
        names = [part.name for part in link.collisions] if link is not None else []
        self.collisions: list[CollisionPath] = []
        """The collisions whose contacts are reported."""
        for child in contact.all("collision"):
            if child.text in names:
                self.collisions.append((description.model, description.link, child.text))
            elif child.text:
                hint = did_you_mean(child.text, names, listing="its collisions are")
                text = f"contact sensor '{description.name}' names collision '{child.text}', which link "
                world.diagnostics.warn(child.where, f"{text}'{description.link}' does not have{hint}")
        if not contact.text_of("collision"):
            hint = did_you_mean("", names, listing="the collisions of its link are")
            text = f"contact sensor '{description.name}' names no <collision>, so it never feels anything{hint}"
            world.diagnostics.warn(contact.where, text)
        self._publisher: Any = None

    def bind(self) -> None:
        self._geoms = CollisionGeoms(self.world)
        self._feeling = {geom for path in self.collisions for geom in self._geoms.of(path)}

    def topic_suffix(self) -> str:
        return "contact"

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.contacts_pb2 import Contacts

        self._type = Contacts
        self._publisher = node.advertise(self.topic, Contacts)

    def offer_set_rate(self, node: Node) -> None:
        """Offer nothing: a contact sensor has no rate."""

    def has_connections(self) -> bool:
        return self._publisher is not None and self._publisher.has_connections()

    def update(self, now_ns: int) -> None:
        pairs: dict[tuple[CollisionPath, CollisionPath], list[ContactPoint]] = {}
        for point in contact_points(self.world, self._feeling):
            other = self._geoms.paths.get(point.other)
            if other is not None:
                pairs.setdefault((self._geoms.paths[point.geom], other), []).append(point)
        if not pairs:
            return
        message = self._type()
        _stamp(message.header, now_ns)
        for path in dict.fromkeys(self.collisions):
            for (own, other), points in pairs.items():
                if own == path:
                    self._add(message.contact.add(), own, other, points, now_ns)
        self._publisher.publish(message)

    def _add(
        self, into: Any, own: CollisionPath, other: CollisionPath, points: list[ContactPoint], now_ns: int
    ) -> None:
        _stamp(into.header, now_ns)
        for entity, path in ((into.collision1, own), (into.collision2, other)):
            entity.id = self.world.entities.number("collision", *path)
            entity.name = "::".join(path)
        for point in points:
            _set(into.position.add(), point.position.tolist())
            _set(into.normal.add(), point.normal.tolist())
            into.depth.append(point.depth)
            wrench = into.wrench.add()
            _set(wrench.body_1_wrench.force, point.force.tolist())
            _set(wrench.body_2_wrench.force, (0.0 - point.force).tolist())


def _stamp(header: Any, now_ns: int) -> None:
    header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)


def _set(into: Any, values: list[float]) -> None:
    into.x, into.y, into.z = values
