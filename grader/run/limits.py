"""How long a run may take, in processor time and in wall time; both are said in the report and in docs/instructors.md.

A run that simulates `duration` [s] has a limit that an idle machine keeps. On a busy machine the clocks by which it is
measured stand still while the processes of the run wait for a processor, so nobody gets less. But no run takes more
than `MACHINES_FACTOR` times as much wall time; what is not done then is the fault of the machine.
"""

from __future__ import annotations

TIME_FACTOR, TIME_GRACE = 2.0, 10.0  # [s] for each simulated second, and for the run
LAUNCH_START = 20.0  # [s] more for a launch, whose processes come up one after the other
MOST_HELD = 45.0  # [s] in which simulated time is held for processes that start up, all of a run together
MACHINES_FACTOR = 20.0


def time_limit(duration: float, launched: bool = False) -> float:
    """Return the time [s] that a run may take once it has begun: of a processor, and of waiting for its processes."""
    return TIME_FACTOR * duration + TIME_GRACE + (LAUNCH_START if launched else 0.0)


def idle_limit(duration: float) -> float:
    """Return how long [s] the processes of a run are waited for on an idle machine, their start included."""
    return time_limit(duration, launched=True) + MOST_HELD


def wall_limit(duration: float) -> float:
    """Return the wall time [s] after which a run is given up, however busy the machine is."""
    return MACHINES_FACTOR * idle_limit(duration)


def limits_of(duration: float, launched: bool = False) -> dict[str, float]:
    """Return both limits [s] of a run as the report says them."""
    return {"processor_seconds": time_limit(duration, launched), "wall_seconds": wall_limit(duration)}
