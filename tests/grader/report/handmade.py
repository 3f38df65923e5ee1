"""What reports are made of: checks, scores, a recording made by hand, and texts nobody would want to read."""

import json
from pathlib import Path
from unittest.mock import patch

import numpy as np
import rerun as rr
from hypothesis import strategies as st

from gz_course.grader.exercise import CheckSpec
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.report.report import HostFacts, Report, TrialReport
from gz_course.grader.score.check import Band, Finding
from gz_course.grader.score.consequences import CheckResult
from gz_course.grader.score.score import Score

DURATION = 4.0
TWIST = {"/cmd_vel": "geometry_msgs/msg/Twist"}
JPEG = b"\xff\xd8\xff\xe0 not much of a picture" + bytes(20_000)
NASTY = [
    "<script>alert(1)</script>", "</pre><h1>", "{{ 7 * 7 }}", "{% raw %}", "]]>", "<!--", "&lt;", "'\"><img src=x>",
    "::error::no", "::set-output name=x::y", "##[group]", "##vso[task.complete]", "\x1b[2J", "\0", "\x9b31m", "\r",
    "\u202e", "\u2028", "\ufffe", "[bold]x[/bold]", "[/]", "a\\", "=1+1", "http://127.0.0.1/x.js", "é∞🤖", "\x85",
    "\x0b",
]  # fmt: skip
nasty = st.one_of(
    st.sampled_from(NASTY), st.text(max_size=60), st.builds("".join, st.lists(st.sampled_from(NASTY), max_size=4))
)


def result(id, passed, measured="was 0.5", **finding):
    spec = CheckSpec(
        id,
        f"Title of {id}",
        50,
        "time_in_band",
        (f"Hint for {id}.",),
        {"conditions": [{"signal": "truth/robot/linear_x", "name": "forward speed", "unit": "m/s"}]},
    )
    bands = (Band("truth/robot/linear_x", 0.45, 0.55, 0.5, 3.0),)
    return CheckResult(spec, Finding(passed, "is 0.5", measured, **({"at_s": 1.25, "bands": bands} | finding)))


def score_of(*checks, outcome="graded", diagnosis=""):
    return Score(checks, outcome, diagnosis, "ab" * 32)


def write_run(path, *, lines=(), facts=None, world=True, speed=0.5, seconds=DURATION):
    """A recording of a robot that drives along the x axis, past a box and a surface, with a camera and a lidar."""
    # The SDK never frees the threads that it makes for the layout of the viewer.
    with patch("gz_course.grader.record.recorder.blueprint", lambda *_: None), Recorder(path, "robot") as recorder:
        if world:
            recorder.static("/world/box/link/visual", rr.Boxes3D(half_sizes=[[0.2, 0.3, 0.5]]))
            recorder.static("/world/box", rr.Transform3D(translation=[1, 1, 0.5], quaternion=[0, 0, 0, 1]))
            recorder.static("/world/robot/base/visual", rr.Cylinders3D(lengths=[0.2], radii=[0.25]))
            for step in range(round(seconds * 10) + 1):
                now, x = step / 10, speed * step / 10
                recorder.set_time(round(now * 1e9))
                recorder.pose("/world/robot", (x, 0.0, 0.1), (1.0, 0.0, 0.0, 0.0))
                for name, value in {"x": x, "y": 0.0, "yaw": 0.0, "linear_x": speed, "angular_z": 0.0}.items():
                    recorder.scalar(f"truth/robot/{name}", value)
                recorder.scalar("truth/robot/distance", x)
                recorder.scalar("topics/cmd_vel/linear/x", 0.5)
                if step % 10 == 0:
                    recorder.points("/world/robot/base/lidar/scan", np.array([[0.5, 0.25, 0.0], [0.5, -0.25, 0.0]]))
                    recorder.picture("topics/camera/image", JPEG + bytes([step]))
        for at, line in lines:
            recorder.set_time(round(at * 1e9))
            recorder.text("log/student", line, "ERROR" if "Error" in line else "INFO")
        recorder.properties(
            "run",
            exercise="03_teleop", submission="node.py", seed=3, duration=DURATION, robot="robot",
            facts=json.dumps({"sim_seconds": seconds, "listened": TWIST} | (facts or {})),
        )  # fmt: skip
    return path


SCORE = score_of(result("good", True), result("bad", False), diagnosis="The bad one: was 0.5.")
REPORT = Report(  # its recording is nowhere
    exercise="03_teleop",
    title="Drive",
    submission="/home/me/teleop_node.py",
    recording=Path("runs/03_teleop.rrd"),
    score=SCORE,
    max_score=100,
    sim_seconds=8.0,
    seed=3,
    versions={"mujoco": "4.0.0"},
    host=HostFacts("D", "lockstep", 0.5, 2.0),
    trials=(TrialReport("public", 3, SCORE, Path("runs/03_teleop.rrd"), "ab" * 32),),
)
