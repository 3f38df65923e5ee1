"""The link to a running world over gz-transport: its model and state come in, what the user does goes out.

Everything that changes the world is a service or a topic of Gazebo (`/world/W/control`, `create`, `remove`,
`set_pose`, a Twist), apart from the protocol of `gz.sim.systems.view_broadcaster`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import mujoco
import numpy as np

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.bytes_pb2 import Bytes
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
from gz_course.sim.gz.msgs.entity_pb2 import Entity
from gz_course.sim.gz.msgs.entity_wrench_pb2 import EntityWrench
from gz_course.sim.gz.msgs.pose_pb2 import Pose
from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V
from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl
from gz_course.sim.gz.msgs.world_reset_pb2 import WorldReset
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.systems.view_broadcaster import split_stamp
from gz_course.sim.gz.transport import Node

_SERVICE_MS = 6000
"""Time [ms] for a service; the simulator itself waits 5 s for the end of a step."""
_ANSWER_S = 0.5
"""Time [s] after which the statistics say what has become of a request."""
_MOST_QUEUED = 32


class WorldLink:
    """One world: `on_model(model)` and `on_state(vector)` are called in threads of the link."""

    def __init__(
        self,
        node: Node,
        on_model: Callable[[mujoco.MjModel], object],
        on_state: Callable[[np.ndarray], object],
    ) -> None:
        self.node = node
        self.world = ""
        """The name of the world; empty until `follow`."""
        self.stats: Any = WorldStatistics()
        """The last statistics of the world."""
        self.said = "waiting for a world"
        """What the status line says."""
        self.states = 0
        """The number of states that have come."""
        self._on_model, self._on_state = on_model, on_state
        self._stamp = -1
        self._wanted = threading.Event()
        self._closed = threading.Event()
        self._calls = ThreadPoolExecutor(1, thread_name_prefix="services of the world")
        self._queued = 0
        self._asked = False, -_ANSWER_S
        """Whether the world shall be paused, and since when [s]."""
        self._fetcher = threading.Thread(target=self._fetch, daemon=True)

    @property
    def waits(self) -> bool:
        """Return whether the world has not answered every request yet."""
        return self._queued > 0

    @property
    def topic(self) -> str:
        return valid_topic(f"/world/{self.world}")

    def find_world(self, patience_ms: int = 1000) -> str:
        """Return the name of a running world, or an empty text if there is none."""
        found, answer = self.node.request("/gazebo/worlds", None, Empty, StringMsg_V, patience_ms)
        return str(answer.data[0]) if found and answer.data else ""

    def follow(self, world: str) -> None:
        """Show this world from now on; it may start later."""
        self.world = world
        self.said = f"waiting for the picture of world '{world}'"
        self._drags = self.node.advertise(f"{self.topic}/view/drag", EntityWrench)
        self.node.subscribe(WorldStatistics, f"{self.topic}/stats", self._take_stats)
        self.node.subscribe_raw(f"{self.topic}/view/state", self._take_state, "gz.msgs.Bytes")
        self._wanted.set()
        self._fetcher.start()

    def close(self) -> None:
        self._closed.set()
        self._wanted.set()
        self._calls.shutdown(wait=False, cancel_futures=True)

    def _take_stats(self, message: Any) -> None:
        self.stats = message

    def _take_state(self, data: bytes, _: Any) -> None:
        stamp, state = split_stamp(Bytes.FromString(data).data)
        if stamp != self._stamp:
            self._wanted.set()
            return
        self.states += 1
        self._on_state(np.frombuffer(state).copy())

    def _fetch(self) -> None:
        """Fetch the model whenever a state of another model has come."""
        while not self._closed.is_set():
            self._wanted.wait()
            self._wanted.clear()
            if self._closed.is_set():
                return
            found, answer = self.node.request(f"{self.topic}/view/model", None, Empty, Bytes, _SERVICE_MS)
            if not found:
                if not self._closed.wait(0.2):
                    self._wanted.set()
                continue
            stamp, content = split_stamp(answer.data)
            model = mujoco.MjModel.from_binary_path("world.mjb", {"world.mjb": content})
            self._stamp = stamp
            self._wanted.clear()
            self._on_model(model)
            if self.said.startswith("waiting"):
                self.said = f"world '{self.world}'"

    def call(self, service: str, request: Any, about: str) -> None:
        """Call a service of the world that answers with a Boolean; the status line says what came of it.

        Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/user_commands/UserCommands.cc (`/blocking`)
        """
        if self._queued >= _MOST_QUEUED:
            return
        self._queued += 1
        self._calls.submit(self._call, f"{self.topic}/{service}", request, about)

    def _call(self, service: str, request: Any, about: str) -> None:
        try:
            answered, response = self.node.request(service, request, type(request), Boolean, _SERVICE_MS)
            if not answered:
                self.said = f"{about}: the world did not answer within {_SERVICE_MS / 1000:g} s"
            elif not response.data:
                self.said = f"{about}: refused; the terminal of gz sim says why"
            else:
                self.said = f"{about}: done"
        finally:
            self._queued -= 1

    def _control(self, about: str, *, pause: bool, **fields: Any) -> None:
        self._asked = pause, time.monotonic()
        self.call("control", WorldControl(pause=pause, **fields), about)

    @property
    def paused(self) -> bool:
        """Return whether the world is paused, or will be when it has done what was asked."""
        asked, at = self._asked
        return asked if time.monotonic() - at < _ANSWER_S else bool(self.stats.paused)

    def play(self) -> None:
        self._control("play", pause=False)

    def pause(self) -> None:
        self._control("pause", pause=True)

    def step(self, count: int) -> None:
        """Run `count` steps of a paused world."""
        self._control(f"{count} step{'s'[: count != 1]}", pause=True, multi_step=count)

    def reset(self) -> None:
        """Reset the world; whether it is paused stays as it is."""
        self._control("reset", pause=self.paused, reset=WorldReset(all=True))

    def create(self, sdf: str, name: str, position: tuple[float, float, float]) -> None:
        """Create a model from SDF text, or from the name of a model if the text does not begin with `<`."""
        request: Any = EntityFactory(name=name, allow_renaming=True)
        if sdf.lstrip().startswith("<"):
            request.sdf = sdf
        else:
            request.sdf_filename = sdf
        request.pose.position.x, request.pose.position.y, request.pose.position.z = position
        self.call("create/blocking", request, f"insert '{name}'")

    def remove(self, name: str) -> None:
        self.call("remove/blocking", Entity(name=name, type=Entity.MODEL), f"remove '{name}'")

    def set_pose(self, name: str, position: np.ndarray, quaternion: np.ndarray) -> None:
        """Move a model, or a link `model::link` that floats; the quaternion is (w, x, y, z)."""
        request: Any = Pose(name=name)
        request.position.x, request.position.y, request.position.z = map(float, position)
        turn = request.orientation
        turn.w, turn.x, turn.y, turn.z = map(float, quaternion)
        self.call("set_pose", request, f"move '{name}'")

    def drag(self, link: str, push: np.ndarray) -> None:
        """Push a link: force [N] and torque [Nm] in the world frame, for a moment; zeros let go."""
        message: Any = EntityWrench()
        message.entity.name, message.entity.type = link, Entity.LINK
        force, torque = message.wrench.force, message.wrench.torque
        force.x, force.y, force.z, torque.x, torque.y, torque.z = map(float, push)
        self._drags.publish(message)

    def topics_of(self, type_name: str) -> list[str]:
        """Return the topics that somebody publishes or hears as `type_name`, sorted."""
        published, subscribed = self.node.publishers_and_subscribers()
        return sorted({each.topic for each in (*published, *subscribed) if each.msg_type_name == type_name})
