"""The base class of all sensors (topic, frame, rate) and the registry of `<sensor type=...>`.

A sensor type is a file in `gz/sim/sensors` with a class under `@sensor_type`, and `SDF_WORDS`, which says what stands
in its `<sensor>` (`sdf/vocabulary.py`). The system named by `runs_in` creates
the sensors and calls `run` when they are due, which calls `update` if there is a subscriber.

Source: http://sdformat.org/spec?elem=sensor
"""

from __future__ import annotations

import hashlib
import math
import struct
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from gz_course.sim.gz.sim.plugins.period import period_ns
from gz_course.sim.gz.sim.plugins.system import scan
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.requests import logged
from gz_course.sim.gz.sim.sdf.description import Sensor

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

NOT_SIMULATED = frozenset(("custom", "multicamera"))
"""The sensor types of SDF that have no file here."""

_ZEROS = (0, 0, 0, 0)
_FRESH = {"bit_generator": "Philox", "buffer": _ZEROS, "buffer_pos": 4, "has_uint32": 0, "uinteger": 0}
"""The initial state of a Philox generator, without its key; NumPy takes tuples faster than arrays."""
_KEY = struct.Struct("<QQ")


class SensorBase:
    """Base of all sensors: parameters common to every type and the schedule of its updates."""

    runs_in = "Sensors"
    """The name of the system that runs sensors of this type."""

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read topic, frame and rate; `world` gives time, poses and the seed."""
        self.world = world
        self.description = description
        element = description.element
        kind, holder = ("joint", description.joint) if description.joint else ("link", description.link)
        self.scoped_name = f"{description.model}::{holder}::{description.name}"
        *scope, own = holder.split("::")
        nested = "".join(f"/model/{part}" for part in scope)
        self.default_topic = (
            f"/world/{world.name}/model/{description.model}{nested}/{kind}/{own}"
            f"/sensor/{description.name}/{self.topic_suffix()}"
        )
        self.topic = valid_topic(element.text_of("topic"), self.default_topic)
        stated = (element.text_of(tag) for tag in ("frame_id", "gz_frame_id", "ignition_frame_id"))
        self.frame_id = next((text for text in stated if text), self.scoped_name)
        rate = element.number("update_rate", 0.0)
        self.highest_rate = rate if 0.0 < rate < math.inf else 0.0
        """`<update_rate>` [Hz], the limit of `set_rate`; 0 means every step."""
        self.period_ns = _period_ns(self.highest_rate)
        self.next_update_ns = 0
        self.updates = 0
        self._last_ns: int | None = None
        self._generators: dict[str, tuple[Any, np.random.Generator, np.random.BitGenerator]] = {}
        """The hash of the text before the number of the update, and the generator, by purpose."""

    def bind(self) -> None:
        """Look up ids in MuJoCo's model, which was just built or rebuilt."""

    def start(self) -> None:
        """Initialize the state at time zero; called after the first `bind` and after every reset."""
        self.next_update_ns = 0
        self.updates = 0
        self._last_ns = None

    def topic_suffix(self) -> str:
        """Return the last part of the default topic."""
        raise NotImplementedError

    def connect(self, node: Node) -> None:
        """Advertise the sensor's topics on `node`, which is this sensor's own."""
        raise NotImplementedError

    def has_connections(self) -> bool:
        """Tell whether there is a subscriber, so that the sensor must be computed."""
        raise NotImplementedError

    def advance(self, dt: float) -> None:
        """Advance internal state such as drifting biases by `dt` [s], the time since the last due update; called at
        every due update, even without a subscriber.
        """

    def update(self, now_ns: int) -> None:
        """Measure and publish; the stamp is `now_ns` [ns] of simulated time."""
        raise NotImplementedError

    def run(self, now_ns: int) -> None:
        """Perform the update that is due at `now_ns` [ns] and schedule the next one."""
        self.advance((now_ns - self._last_ns) * 1e-9 if self._last_ns is not None else 0.0)
        self._last_ns = now_ns
        if self.has_connections():
            self.update(now_ns)
        self.updates += 1
        period = self.period_ns
        self.next_update_ns += period
        if period and self.next_update_ns <= now_ns:
            self.next_update_ns += ((now_ns - self.next_update_ns) // period + 1) * period

    def offer_set_rate(self, node: Node) -> None:
        """Offer the one-way service `<topic>/set_rate` (gz.msgs.Double, [Hz]) on `node`."""
        from gz_course.sim.gz.msgs.double_pb2 import Double
        from gz_course.sim.gz.msgs.empty_pb2 import Empty

        service = f"{self.topic}/set_rate"

        def serve(request: Double) -> Empty:
            self.world.requests.put(logged(lambda: self.set_rate(request.data), service))
            return Empty()

        node.advertise_service(service, Double, Empty, serve)

    def set_rate(self, rate: float) -> None:
        """Lower the update rate to `rate` [Hz], at most `<update_rate>`; if that is 0, accept any rate, also 0 for
        every step.

        Refuses other requests with a warning.
        """
        if math.isnan(rate):
            self.world.drop_command(f"{self.topic}/set_rate", "rate")
            return
        rate = max(0.0, rate)
        highest = self.highest_rate
        if highest and (rate == 0.0 or rate > highest * (1.0 + 1e-6)):
            text = f"sensor '{self.scoped_name}' keeps its rate: {rate:g} Hz was asked for, 0 is not possible and "
            self.world.diagnostics.warn("", text + f"<update_rate> allows {highest:g} Hz at most")
            return
        self.period_ns = _period_ns(rate)
        if self.period_ns == 0:
            self.next_update_ns = 0
        self.rescheduled()

    def rescheduled(self) -> None:
        """Notify the system that runs the sensor that the next update may be earlier than planned; the system replaces
        this.
        """

    def random(self, purpose: str = "noise") -> np.random.Generator:
        """Return the random generator of this sensor's current update.

        It depends only on the seed of the world, the name of the sensor, `purpose` and the number of the update, so
        that subscribers do not change the numbers. Valid until the next call for the same purpose.
        """
        return self._generator(purpose, self.updates)

    def constant_random(self, purpose: str) -> np.random.Generator:
        """Return the random generator for values drawn once per run, such as a bias."""
        return self._generator(purpose, -1)

    def _generator(self, purpose: str, update: int) -> np.random.Generator:
        found = self._generators.get(purpose)
        if found is None:
            begun = hashlib.sha256(f"{self.world.seed}/{self.scoped_name}/{purpose}/".encode())
            generator = np.random.Generator(np.random.Philox(key=0))
            found = self._generators[purpose] = begun, generator, generator.bit_generator
        begun, generator, bits = found
        text = begun.copy()
        text.update(b"%d" % update)
        # Setting the key is much faster than making a generator, and draws the same numbers.
        bits.state = {**_FRESH, "state": {"counter": _ZEROS, "key": _KEY.unpack_from(text.digest())}}
        return generator

    def fill_header(self, header: Any, now_ns: int) -> None:
        """Write stamp, frame and sequence number as Gazebo does."""
        header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)
        for key, value in (("frame_id", self.frame_id), ("seq", str(self.updates))):
            entry = header.data.add()
            entry.key = key
            entry.value.append(value)


def _period_ns(rate: float) -> int:
    # Gazebo keeps the period in whole milliseconds: 30 Hz means every 33 ms.
    return period_ns(rate) // 1_000_000 * 1_000_000


S = TypeVar("S", bound=type[SensorBase])
_TYPES: dict[str, type[SensorBase]] = {}


def sensor_type(*names: str) -> Callable[[S], S]:
    """Register a class for these values of `<sensor type=...>`."""

    def register(cls: S) -> S:
        for name in names:
            _TYPES[name] = cls
        return cls

    return register


def sensor_types() -> dict[str, type[SensorBase]]:
    """Return the class of every sensor type, by the value of `<sensor type=...>`."""
    scan("sensors")
    return dict(_TYPES)
