"""The server of a world: publishes its clock and statistics, and runs it at wall-clock pace.

`gz sim` and launch files use `run`, the grader uses `step`. Topics, as in Gazebo: `/clock` and `/world/W/clock`
(gz.msgs.Clock), `/stats` and `/world/W/stats` (gz.msgs.WorldStatistics) at 10 Hz. Services are in `world_services`;
requests are handled between two steps, also while the world is paused.

The clock is published after every call of `step`, and by `run` at most every 5 ms of simulated time. Gazebo publishes
it at every step; with steps of 1 ms this costs each rclpy node a third of a core without a benefit for a robot's node.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/SimulationRunner.cc
"""

from __future__ import annotations

import threading
import time
from typing import Any

from gz_course.sim.gz.msgs.clock_pb2 import Clock
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.sim.control import Control
from gz_course.sim.gz.sim.errors import LOG, SimError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.sim.world_services import WorldServices
from gz_course.sim.gz.transport import Node
from gz_course.sim.gz.transport.reach import sending_together

STATS_PERIOD_NS = 100_000_000
PACE_NS = 5_000_000
"""Simulated time [ns] between two clock messages in `run`; at least one step."""
BURST_NS = 1_000_000
"""Wall time [ns] for which messages to other processes are collected in `run` as fast as possible."""
_NOTICE_S = 0.05
"""Period [s] at which a paused server checks whether it has been stopped."""


class Server:
    """Runs a world on a transport node; `paused` may be set from any thread during `run`."""

    offers_view = True
    """Whether a view can be opened beside it."""

    def __init__(self, world: World, node: Node) -> None:
        """Attach `world` to `node` (if not yet attached), advertise clock and statistics, and offer the services."""
        self.world = world
        self.node = node
        self.control = Control(world, self._on_rewind)
        self.stopped = False
        """True after a client has requested the end of the server."""
        world.attach(node)
        stem = world.topic
        self._clock: Any = Clock()
        self._clocks = [node.advertise(topic, Clock) for topic in ("/clock", f"{stem}/clock")]
        self._stats = [node.advertise(topic, WorldStatistics) for topic in ("/stats", f"{stem}/stats")]
        self._factor = 0.0
        self._pause_began: int | None = None
        self._on_rewind()
        self._services = WorldServices(world, node, self.control, self._stop)

    def _stop(self) -> None:
        self.stopped = True

    @property
    def paused(self) -> bool:
        """Return whether `run` is paused; `step` ignores it."""
        return self.control.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.control.paused = paused

    def step(self, n: int = 1) -> None:
        """Run `n` steps, publish the clock and, every 0.1 [s] of simulated time, the statistics; pending requests run
        first.

        Raises SimError like `World.step`.
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
        update_rate: float | None = None,
        iterations: int = 0,
        stop: threading.Event | None = None,
    ) -> None:
        """Step at wall-clock pace until `stop` is set, a client stops the server, or `iterations` steps are done (0: no
        end).

        `real_time_factor` 1 is real time, 0 as fast as possible, None that of the world; `update_rate` (steps per
        second of wall time) replaces it. On a slow machine simulated time falls behind and is not caught up in a burst.
        While paused, clock and statistics are published ten times per second and requests are handled. Unstable physics
        pauses the world, or raises SimError with `iterations`, which would never be reached.
        """
        stop = stop or threading.Event()
        world = self.world
        left = iterations if iterations > 0 else -1
        due = beat = measured = time.monotonic_ns()
        advanced = 0
        while not (stop.is_set() or self.stopped or left == 0):
            world.requests.serve()
            if self.paused:
                self._wait_paused(stop)
                due = beat = measured = time.monotonic_ns()
                advanced = 0
                continue
            step_ns = world.step_size_ns
            factor = self._wanted_factor(real_time_factor, update_rate)
            with sending_together():
                count = self._burst(left, due + BURST_NS if factor == 0.0 else 0, iterations > 0)
            left -= count if left > 0 else 0
            advanced += count * step_ns
            now = time.monotonic_ns()
            if now - measured >= 200_000_000:
                self._factor = advanced / (now - measured)
                measured, advanced = now, 0
            if now - beat >= STATS_PERIOD_NS or self.paused:
                beat = now
                self._publish_stats()
            if factor == 0.0:
                due = now
            else:
                due += int(count * step_ns / factor)
                if due > now:
                    stop.wait((due - now) * 1e-9)
                elif now - due > 100_000_000:
                    due = now
        if left == 0:
            self._publish_stats()

    def _wanted_factor(self, real_time_factor: float | None, update_rate: float | None) -> float:
        if update_rate is not None:
            return update_rate * self.world.step_size_ns * 1e-9
        return self.world.description.real_time_factor if real_time_factor is None else real_time_factor

    def _burst(self, left: int, until: int, strict: bool) -> int:
        """Step and publish the clock, again and again up to the monotonic time `until` [ns], if nothing is asked for;
        return how many steps have run, at most `left` if it is not negative.
        """
        pace = max(1, PACE_NS // self.world.step_size_ns)
        done = 0
        while True:
            count = self.control.steps_allowed(pace)
            done += self._advance(count if left < 0 else min(count, left - done), strict)
            if done == left or self.control.changed or self.control.paused or time.monotonic_ns() >= until:
                return done

    def _advance(self, count: int, strict: bool) -> int:
        """Step until a request pauses, steps or resets the world; publish the clock, return how many steps have run.

        On unstable physics pause and log it.
        """
        control = self.control
        control.changed = False
        try:
            count = self.world.step(count, lambda: control.changed)
        except SimError as error:
            if strict:
                raise
            self.paused = True
            LOG.error("%s; the world is paused", error)
            return 0
        if not control.changed:  # else the steps were run before the request, and are none of those it asks for
            control.stepped(count)
        self._publish_clock()
        return count

    def _wait_paused(self, stop: threading.Event) -> None:
        """Handle requests at once and publish the time ten times per second, until unpaused or stopped."""
        self._pause_began = beat = time.monotonic_ns()
        self._factor = 0.0
        self._publish_paused()
        while self.paused and not (stop.is_set() or self.stopped):
            self.world.requests.wait(_NOTICE_S)
            asked = bool(self.world.requests)
            self.world.requests.serve()
            now = time.monotonic_ns()
            if asked or now - beat >= STATS_PERIOD_NS:
                beat = now
                self._publish_paused()
        self._pause_ns = self._pause_time_ns(time.monotonic_ns())
        self._pause_began = None

    def _publish_paused(self) -> None:
        self._publish_stats()
        self._publish_clock()
        self.world.paused_update()

    def _on_rewind(self) -> None:
        """Restart the clocks of the server after a reset of the world."""
        self._next_stats_ns = self.world.sim_time_ns + STATS_PERIOD_NS
        self._started = time.monotonic_ns()
        self._pause_ns = 0
        if self._pause_began is not None:
            self._pause_began = self._started

    def _pause_time_ns(self, now: int) -> int:
        """Return how long the world has been paused since the start [ns], at the monotonic time `now` [ns]."""
        return self._pause_ns + (now - self._pause_began if self._pause_began is not None else 0)

    def _real_time_ns(self) -> int:
        """Return how long the world has run since the start [ns]; as in Gazebo without pauses."""
        now = time.monotonic_ns()
        return now - self._started - self._pause_time_ns(now)

    def _publish_clock(self) -> None:
        listened = [publisher for publisher in self._clocks if publisher.has_connections()]
        if not listened:
            return
        message = self._clock  # Publishing serializes it at once, so that one message object can be reused.
        sim, real, system = message.sim, message.real, message.system
        sim.sec, sim.nsec = divmod(self.world.sim_time_ns, 1_000_000_000)
        real.sec, real.nsec = divmod(self._real_time_ns(), 1_000_000_000)
        system.sec, system.nsec = divmod(time.time_ns(), 1_000_000_000)
        for publisher in listened:
            publisher.publish(message)

    def _publish_stats(self) -> None:
        listened = [publisher for publisher in self._stats if publisher.has_connections()]
        if not listened:
            return
        message: Any = WorldStatistics()
        _fill_time(message.header.stamp, self.world.sim_time_ns)
        _fill_time(message.sim_time, self.world.sim_time_ns)
        _fill_time(message.real_time, self._real_time_ns())
        _fill_time(message.pause_time, self._pause_time_ns(time.monotonic_ns()))
        _fill_time(message.step_size, self.world.step_size_ns)
        message.paused = self.paused
        message.stepping = self.control.stepping
        message.iterations = self.world.iterations
        message.model_count = len(self.world.description.models)
        message.real_time_factor = self._factor
        for publisher in listened:
            publisher.publish(message)


def _fill_time(field: Any, nanoseconds: int) -> None:
    field.sec, field.nsec = divmod(nanoseconds, 1_000_000_000)
