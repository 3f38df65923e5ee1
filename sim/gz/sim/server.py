"""A world on the wire: publishes its clock and statistics, and runs it against the wall clock when asked to.

`gz sim` and launch files use `run`; a grader that owns the time uses `step`. Topics, as in Gazebo: `/clock`
and `/world/W/clock` (gz.msgs.Clock) after every call of `step`, `/stats` and `/world/W/stats`
(gz.msgs.WorldStatistics) at 10 Hz.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from gz.msgs.clock_pb2 import Clock
from gz.msgs.world_stats_pb2 import WorldStatistics

from gz.sim.world import World
from gz.transport import Node

STATS_PERIOD_NS = 100_000_000
PACE_NS = 5_000_000
"""In `run`, this much simulated time is stepped at once (one step when steps are longer), then the clock is
published.
"""


class Server:
    """Owns a world and the node it talks through. `paused` may be set from any thread while `run` runs."""

    def __init__(self, world: World, node: Node) -> None:
        """Attach `world` to `node` (unless it already is) and advertise clock and statistics."""
        self.world = world
        self.node = node
        self.paused = False
        world.attach(node)
        name = world.name
        self._clocks = [node.advertise(topic, Clock) for topic in ("/clock", f"/world/{name}/clock")]
        self._stats = [node.advertise(topic, WorldStatistics) for topic in ("/stats", f"/world/{name}/stats")]
        self._next_stats_ns = world.sim_time_ns + STATS_PERIOD_NS
        self._started = time.monotonic_ns()
        self._pause_ns = 0
        self._factor = 0.0

    def step(self, n: int = 1) -> None:
        """Run `n` steps, then publish the clock, and the statistics each time 0.1 s of simulated time has
        passed.
        """
        world = self.world
        world.step(n)
        self._publish_clock()
        if world.sim_time_ns >= self._next_stats_ns:
            self._next_stats_ns += STATS_PERIOD_NS * (1 + (world.sim_time_ns - self._next_stats_ns) // STATS_PERIOD_NS)
            self._publish_stats()

    def run(
        self,
        *,
        real_time_factor: float | None = None,
        iterations: int = 0,
        stop: threading.Event | None = None,
    ) -> None:
        """Step until `stop` is set or `iterations` steps are done (0: no end), paced to the wall clock.

        `real_time_factor` 1 is real time, 0 as fast as possible, None what the world file says. When the
        machine is too slow, simulated time falls behind; it is not caught up later in a burst. While paused
        only statistics are sent.
        """
        stop = stop or threading.Event()
        factor = self.world.description.real_time_factor if real_time_factor is None else real_time_factor
        step_ns = self.world.step_size_ns
        batch = max(1, PACE_NS // step_ns)
        left = iterations if iterations > 0 else -1
        due = time.monotonic_ns()
        measured = (due, self.world.sim_time_ns)
        while not stop.is_set() and left != 0:
            if self.paused:
                self._wait_paused(stop)
                due = time.monotonic_ns()
                measured = (due, self.world.sim_time_ns)
                continue
            count = batch if left < 0 else min(batch, left)
            self.step(count)
            left -= count if left > 0 else 0
            now = time.monotonic_ns()
            if now - measured[0] >= 200_000_000:
                self._factor = (self.world.sim_time_ns - measured[1]) / (now - measured[0])
                measured = (now, self.world.sim_time_ns)
            if factor > 0.0:
                due += int(count * step_ns / factor)
                if due > now:
                    stop.wait((due - now) * 1e-9)
                elif now - due > 100_000_000:
                    due = now

    def _wait_paused(self, stop: threading.Event) -> None:
        """Send statistics ten times a second until unpaused or stopped."""
        began = time.monotonic_ns()
        self._factor = 0.0
        while self.paused and not stop.wait(0.1):
            self._publish_stats()
            self._publish_clock()
        self._pause_ns += time.monotonic_ns() - began

    def _publish_clock(self) -> None:
        listened = [publisher for publisher in self._clocks if publisher.has_connections()]
        if not listened:
            return
        message = Clock()
        _fill_time(message.sim, self.world.sim_time_ns)
        _fill_time(message.real, time.monotonic_ns() - self._started)
        _fill_time(message.system, time.time_ns())
        for publisher in listened:
            publisher.publish(message)

    def _publish_stats(self) -> None:
        listened = [publisher for publisher in self._stats if publisher.has_connections()]
        if not listened:
            return
        message: Any = WorldStatistics()
        _fill_time(message.header.stamp, self.world.sim_time_ns)
        _fill_time(message.sim_time, self.world.sim_time_ns)
        _fill_time(message.real_time, time.monotonic_ns() - self._started)
        _fill_time(message.pause_time, self._pause_ns)
        _fill_time(message.step_size, self.world.step_size_ns)
        message.paused = self.paused
        message.iterations = self.world.iterations
        message.model_count = len(self.world.description.models)
        message.real_time_factor = self._factor
        for publisher in listened:
            publisher.publish(message)


def _fill_time(field: Any, nanoseconds: int) -> None:
    field.sec, field.nsec = divmod(nanoseconds, 1_000_000_000)
