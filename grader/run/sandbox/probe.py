"""A test of a level on this machine: a node in a sandbox of that level and one outside exchange a message over DDS.

Run as a separate program (`python -m grader.run.sandbox.probe A`), because it enters a private network and loads ROS.
Prints nothing on success, else the reason, with exit code 1.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Callable

from gz_course.grader.errors import CourseError
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.sandbox.level import LEVELS, level_module
from gz_course.grader.run.sandbox.resource_monitor import descendants

# [s] for one level, by a clock that stands still while the probe waits for a processor; it takes about one.
DEADLINE = 20.0
LOOK_AGAIN = 0.2  # [s] between two looks at that clock
TOPIC = "/course_sandbox"
SILENT = "no message came through within {seconds:g} s"
# An answer proves both directions: one message went in and another came out.
INSIDE = f"""
import sys
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("inside")
answers = node.create_publisher(String, "{TOPIC}/out", 10)
node.create_subscription(String, "{TOPIC}/in", lambda m: answers.publish(String(data=m.data[::-1])), 10)
rclpy.spin(node)
"""


def try_levels(attempt: Callable[[str], str]) -> tuple[str, dict[str, str], bool]:
    """Return the best level that works, why each better one does not, and whether the answer is certain.

    `attempt` tries one level, as `try_level` does. A level that is refused will be refused again; one that timed out
    may have met a busy machine.
    """
    why: dict[str, str] = {}
    certain = True
    for level in LEVELS[:-1]:
        reason = level_module(level).missing() or attempt(level)
        if not reason:
            return level, why, certain
        why[level] = reason
        certain = certain and "within" not in reason
    return LEVELS[-1], why, certain


def try_level(level: str, deadline: float = DEADLINE) -> str:
    """Return why a level does not work here; empty if it works."""
    command = [sys.executable, "-m", __name__, level, str(deadline)]
    probe = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True)
    patience = _patience(probe.pid, deadline + 5.0)
    try:
        while not patience.over():
            with contextlib.suppress(subprocess.TimeoutExpired):
                told = probe.communicate(timeout=LOOK_AGAIN)[0].decode(errors="replace").strip()
                break
        else:
            return SILENT.format(seconds=deadline)
    finally:
        if probe.poll() is None:
            os.killpg(probe.pid, 9)
            probe.communicate()
    return "" if probe.returncode == 0 else told.splitlines()[-1] if told else f"exit code {probe.returncode}"


def exchange(level: str, deadline: float) -> str:
    """Send a message into a sandbox and wait for its answer; return what went wrong, empty if nothing did."""
    from gz_course.grader.run.domain import Domain
    from gz_course.grader.run.sandbox.sandbox import Sandbox

    with Domain() as domain:
        sandbox = Sandbox(domain.id, level)
        try:
            file = sandbox.put_files({"inside.py": INSIDE.encode()}) / "inside.py"
            boxed = sandbox.start([sys.executable, "-P", str(file)], {})
            os.environ.update(sandbox.grader_environment())
            import rclpy
            from std_msgs.msg import String

            rclpy.init(args=[])
            node = rclpy.create_node("outside")
            heard: list[str] = []
            questions = node.create_publisher(String, f"{TOPIC}/in", 10)
            node.create_subscription(String, f"{TOPIC}/out", lambda message: heard.append(message.data), 10)
            patience = _patience(os.getpid(), deadline)
            while "olleh" not in heard and not patience.over() and boxed.poll() is None:
                questions.publish(String(data="hello"))
                rclpy.spin_once(node, timeout_sec=0.05)
            if "olleh" in heard:
                return ""
            if boxed.poll() is not None:
                told = boxed.stderr.read().decode(errors="replace").strip().splitlines()
                return f"a node in the box ended with exit code {boxed.poll()}{': ' + told[-1] if told else ''}"
            return SILENT.format(seconds=deadline)
        finally:
            sandbox.close()


def _patience(pid: int, seconds: float) -> Patience:
    return Patience(FairClock(lambda: [pid, *descendants(pid)]), seconds)


def main() -> None:
    """Try the level in argv[1] for at most argv[2] seconds."""
    try:
        told = exchange(sys.argv[1], float(sys.argv[2]))
    except CourseError as error:
        told = str(error)
    if told:
        print(told, flush=True)
    os._exit(1 if told else 0)


if __name__ == "__main__":
    main()
