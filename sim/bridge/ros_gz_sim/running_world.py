"""The world of a running `gz sim`, accessed by Gazebo's services, with one deadline for all calls.

Used by the programs of ros_gz_sim. Without an answer in time it raises Failure with the names of the running worlds.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable

from google.protobuf.message import Message

from gz_course.sim import machine_clock
from gz_course.sim.bridge.ros_gz_sim.flags import Flag
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.transport import Node
from gz_course.sim.ros.ros_program.errors import Failure, UsageError

TIMEOUT = Flag("timeout", "Longest wait for the world, in s of wall time (default 10)", "number")
DEFAULT_TIMEOUT_S = 10.0
_LONGEST_S = 1e6
_OF_WORLD = re.compile("/world/([^/]+)/")


class RunningWorld:
    """A world that may still be starting; without a `name` the first world found.

    `timeout` [s] is for all calls together, counted from `start` [s] of `machine_clock.now`, by default now. `warn` is
    called with a sentence when only other worlds run. Raises Failure if no simulator answers.
    """

    def __init__(
        self, node: Node, name: str, timeout: float, warn: Callable[[str], object], *, start: float | None = None
    ) -> None:
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V

        if not 0.0 < timeout <= _LONGEST_S:
            raise UsageError(f"-{TIMEOUT.name} must be above 0 and at most {_LONGEST_S:g} s, got {timeout:g}")
        self._node = node
        self._timeout = timeout
        self._end = (machine_clock.now() if start is None else start) + timeout
        done, answer = node.request("/gazebo/worlds", None, Empty, StringMsg_V, self._left_ms())
        if not done or not answer.data:
            where = os.environ.get("GZ_PARTITION")
            raise Failure(
                f"no simulator answered within {timeout:g} s; start gz sim with the same GZ_PARTITION"
                + (f" as here ('{where}')" if where else " (here it is not set)")
            )
        self.name = name or str(answer.data[0])
        self._topic = valid_topic(f"/world/{self.name}")
        if name and name not in answer.data and not self._is_there():
            warn(f"Waiting for world '{name}': {self._others()}")

    def call(self, verb: str, request: Message) -> bool:
        """Call `/world/NAME/VERB` and wait until it is done; return False if the simulator refuses.

        Raises Failure if there is no answer in time.
        """
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean

        service = f"{self._topic}/{verb}/blocking"  # the service without /blocking answers before it is done
        kind = request.DESCRIPTOR.full_name
        outcome = self._node.call_raw(
            service, request.SerializeToString(), kind, Boolean.DESCRIPTOR.full_name, self._left_ms()
        )
        if not outcome.executed:
            raise Failure(self._why_silent(service, verb))
        return outcome.result and bool(Boolean.FromString(outcome.response).data)

    def entities(self) -> tuple[list[str], list[str]]:
        """Return the names of all models and of all lights; both empty if the world has no SceneBroadcaster."""
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.scene_pb2 import Scene

        patience = min(2000, max(500, self._left_ms()))
        _, scene = self._node.request(f"{self._topic}/scene/info", None, Empty, Scene, patience)
        return [model.name for model in scene.model], [light.name for light in scene.light]

    def resolve(self, uri: str) -> str:
        """Return the path the simulator finds for a URI; empty if it finds none."""
        from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

        service = "/gazebo/resource_paths/resolve"
        done, answer = self._node.request(service, StringMsg(data=uri), StringMsg, StringMsg, self._left_ms())
        return str(answer.data) if done else ""

    def _left_ms(self) -> int:
        return max(1, round((self._end - machine_clock.now()) * 1000))

    def _is_there(self) -> bool:
        return self._topic.removeprefix("/world/") in self._worlds()

    def _worlds(self) -> set[str]:
        return {found[1] for service in self._node.service_list() if (found := _OF_WORLD.match(service))}

    def _others(self) -> str:
        worlds = sorted(self._worlds())
        return f"worlds that run are: {', '.join(worlds) or 'none'}{did_you_mean(self.name, worlds)}"

    def _why_silent(self, service: str, verb: str) -> str:
        if service in self._node.service_list():
            return (
                f"world '{self.name}' did not answer to '{verb}' within {self._timeout:g} s and may still do it; "
                f"a larger -{TIMEOUT.name} waits longer"
            )
        if self._is_there():
            return (
                f"world '{self.name}' runs but offers no service '{service}'; it needs the plugin "
                "gz-sim-user-commands-system, which a world with plugins of its own must name"
            )
        return f"no world '{self.name}' appeared within {self._timeout:g} s; {self._others()}"
