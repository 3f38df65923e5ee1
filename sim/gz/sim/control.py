"""Pauses, steps and resets a running world on requests of the service `/world/W/control`.

`Server.run` asks `Control` before every batch how many steps are allowed. Requests arrive through `World.requests`, so
that all of this runs in the stepping thread. As in Gazebo every request sets whether the world is paused afterwards,
`multi_step` applies to a paused world only, and a reset does not pause.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/SimulationRunner.cc
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.errors import LOG, SimError

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.world import World

MOST_STEPS = 2**32 - 1


class Control:
    """The run state of a world: whether it is paused, and the number of steps until it pauses again."""

    def __init__(self, world: World, on_rewind: Callable[[], None]) -> None:
        """Start unpaused; `on_rewind()` is called after a reset."""
        self._world = world
        self._on_rewind = on_rewind
        self.paused = False
        self.stepping = False
        """True while a paused world runs the requested number of steps."""
        self.changed = False
        """Whether a request was applied since somebody set it to False."""
        self.end_ns: int | None = None
        """The simulated time [ns] at which the world pauses, for example the end of a recording."""
        self._steps_left = 0
        self._run_to_ns: int | None = None

    def apply(self, message: Any) -> None:
        """Apply a gz.msgs.WorldControl. Raises SimError if it cannot be applied."""
        if (
            message.HasField("reset")
            and message.reset.model_only
            and not (message.reset.all or message.reset.time_only)
        ):
            LOG.warning("resetting models only is not supported, as in Gazebo; use reset: {all: true}")
        if message.seed:
            LOG.warning("the seed of a running world cannot be changed, as in Gazebo; start it with gz sim --seed")
        self.changed = True
        self.paused = message.pause
        self.stepping = False
        self._steps_left = 0
        steps = message.multi_step or int(message.step)
        if steps and self.paused:
            self._steps_left = steps
            self.stepping = True
            self.paused = False
        if message.HasField("reset") and (message.reset.all or message.reset.time_only):
            self._world.reset(time_only=not message.reset.all)
            self._on_rewind()
        self._run_to_ns = None
        if message.HasField("run_to_sim_time"):
            wanted = message.run_to_sim_time.sec * 10**9 + message.run_to_sim_time.nsec
            if wanted > self._world.sim_time_ns:
                self._run_to_ns = wanted
            elif wanted > 0:
                now = self._world.sim_time_ns * 1e-9
                raise SimError(f"run_to_sim_time {wanted * 1e-9:g} s is not ahead of the present time, {now:g} s")

    def steps_allowed(self, most: int) -> int:
        """Return how many steps, at most `most`, may run before the next call."""
        if self._steps_left:
            most = min(most, self._steps_left)
        for end_ns in (self._run_to_ns, self.end_ns):
            if end_ns is not None:
                most = min(most, max(1, -(-(end_ns - self._world.sim_time_ns) // self._world.step_size_ns)))
        return most

    def stepped(self, count: int) -> None:
        """Record that `count` steps have run; pause after the last requested one."""
        if self._steps_left:
            self._steps_left -= min(count, self._steps_left)
            if not self._steps_left:
                self.paused, self.stepping = True, False
        if self._run_to_ns is not None and self._world.sim_time_ns >= self._run_to_ns:
            self._run_to_ns = None
            self.paused = True
        if self.end_ns is not None and self._world.sim_time_ns >= self.end_ns:
            self.paused = True

    def seek(self, time_ns: int) -> None:
        """Continue at a simulated time [ns], which a playback then shows."""
        self._world.continue_from(time_ns)
        self._world.systems.start()
        self._on_rewind()
        self.changed = True
