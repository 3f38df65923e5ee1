"""The base class of sensors that measure a few numbers at one point: one site, topic and message, and noise by channel.

A subclass such as `imu.py`, `altimeter.py` or `magnetometer.py` returns its noises and fills in the message.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from gz_course.sim.gz.sim.physics.motion import SiteMotion
from gz_course.sim.gz.sim.plugins.noise import Channels, Noise
from gz_course.sim.gz.sim.plugins.sensor import SensorBase
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


class SiteSensor(SensorBase):
    """Base of the sensors that measure at one point; `motion` is that of the sensor, `noise` holds its channels."""

    suffix: ClassVar[str]
    """The last part of the default topic."""
    message_type: ClassVar[str]
    """The name of the message type, for example gz.msgs.IMU."""

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        self.noise = Channels(self, self.read_noises(description.element))
        self._publisher: Any = None

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noise of each number with the name of its channel; `element` is the `<sensor>`."""
        raise NotImplementedError

    def fill_constant(self, message: Any) -> None:
        """Write what is the same in every message; `fill` finds it there."""

    def fill(self, message: Any) -> None:
        """Measure, and write everything but the header into `message`, which holds what the last update wrote."""
        raise NotImplementedError

    def bind(self) -> None:
        self.motion = SiteMotion(self.world, self.scoped_name)

    def start(self) -> None:
        super().start()
        self.noise.start()

    def advance(self, dt: float) -> None:
        self.noise.advance(dt)

    def topic_suffix(self) -> str:
        return self.suffix

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs import message_class

        kind: Any = message_class(self.message_type)
        self._publisher = node.advertise(self.topic, kind)
        self._filled = kind()  # used again and again, because publishing serializes it at once
        self.fill_header(self._filled.header, 0)
        self.fill_constant(self._filled)

    def has_connections(self) -> bool:
        return self._publisher is not None and self._publisher.has_connections()

    def update(self, now_ns: int) -> None:
        message = self._filled
        header = message.header
        header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)
        header.data[-1].value[0] = str(self.updates)
        self.fill(message)
        self._publisher.publish(message)


def noise_at(element: Element, path: str) -> Noise:
    """Return the noise at `path/noise` below an element; none if it is missing."""
    return Noise.from_sdf(element.find(f"{path}/noise"))
