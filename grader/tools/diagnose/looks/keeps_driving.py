"""A robot that drives on without commands: Gazebo's drive systems keep the last Twist for ever."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("empty_frames",)
SILENCE = 0.5  # [s] without a command after which a real base would stop
MOVES = 0.02  # [m/s] or [rad/s]


def look(system: System) -> Iterator[Finding]:
    """Find drives whose odometry shows motion after the last command."""
    for world in system.gz.worlds:
        for drive in world.drives:
            if not drive.speeds:
                continue
            last, speed, turn = drive.speeds[-1]
            since = max(drive.commands) if drive.commands else drive.speeds[0][0]
            if last - since < SILENCE or max(speed, turn) < MOVES:
                continue
            heard = f"{last - since:.1f} s" if drive.commands else f"{system.gz.seconds:.1f} s or longer"
            yield Finding(
                Severity.WARNING,
                f"{drive.model} drives on at {speed:.2f} m/s and {turn:.2f} rad/s though nobody has commanded it for "
                f"{heard}: {drive.system} keeps the last command for ever.",
                "Send a zero Twist when your node ends, and repeat commands at 10 Hz or more, so that a watchdog can "
                "tell silence from an order.",
                (f"commands on {drive.command_topic}: {len(drive.commands)}, odometry on {drive.odometry_topic}",),
            )
