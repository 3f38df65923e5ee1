"""The cells that the reader of chapter 6 writes."""

from __future__ import annotations

import math
from typing import Any

from gz_course.grader.lessons.step import COMMANDS, NotYet, Tried, expect, step

YARD = "gz sim ../../exercises/06_spawn/yard.sdf -r -s"
SCAN, SCAN_TYPE = "/model/wagon/scan", "sensor_msgs/msg/LaserScan"
BRIDGE = "ros2 run ros_gz_bridge parameter_bridge"
CLEAR = 0.35  # [m] around the lidar, in which there is only the robot


@step("third_cart", objective=2, form=COMMANDS)
def third_cart(tried: Tried) -> str:
    """A cart `third` stands 1 m ahead and 1 m to the right of the origin, and faces left."""
    pose = tried.poses("third")[-1]
    seen = f"`third` is at x {pose.x:z.2f} m, y {pose.y:z.2f} m, and faces {pose.yaw:z.2f} rad"
    try:
        expect(math.dist((pose.x, pose.y), (1.0, -1.0)) < 0.1, f"{seen}; x 1 m and y -1 m are wanted.")
        off = math.remainder(pose.yaw - math.pi / 2, math.tau)
        expect(abs(off) < 0.05, f"{seen}; to the left means a quarter turn, in radians.")
    except NotYet:
        tried.remove("third")  # so that the next try may have the name
        raise
    return f"{seen}: to the left."


@step("wheel_inertia", objective=1)
def wheel_inertia(tried: Tried) -> str:
    """wheel_inertia(mass, radius, length) gives the three moments of inertia of a wheel whose axle is z."""
    function = tried.function("wheel_inertia")
    for mass, radius, length in ((0.4, 0.06, 0.03), (2.0, 0.1, 0.3)):
        across = mass * (3 * radius**2 + length**2) / 12
        wanted = (across, across, mass * radius**2 / 2)
        said = function(mass, radius, length)
        shape = f"For {mass:g} kg, radius {radius:g} m, length {length:g} m"
        expect(
            isinstance(said, tuple | list) and len(said) == 3 and all(isinstance(each, float | int) for each in said),
            f"{shape} it returns {said!r}; three numbers, (ixx, iyy, izz), are wanted.",
        )
        for name, got, want in zip(("ixx", "iyy", "izz"), said, wanted, strict=True):
            expect(
                math.isclose(got, want, rel_tol=1e-6),
                f"{shape}, {name} is {got:.3g} kg m2; {want:.3g} is wanted.",
            )
    return "Two wheels have the moments of inertia that you compute."


@step("lidar", objective=1, form="lidar.urdf.xacro")
def lidar(tried: Tried) -> str:
    """A wagon with a lidar: 10 scans a second, 180 rays all around, in the frame lidar_link."""
    said = tried.command("xacro lidar.urdf.xacro -o lidar.urdf && echo expanded")
    expect(said.endswith("expanded\n"), f"xacro says: {_last(said)}")
    tried.stop("gz sim")
    try:
        tried.start(YARD, ready="")
        said = tried.command("ros2 run ros_gz_sim create -file lidar.urdf -z 0.1", deadline=30.0)
        expect("Entity creation successful" in said, f"create says: {_last(said)}")
        tried.start(f"{BRIDGE} {SCAN}@{SCAN_TYPE}[gz.msgs.LaserScan", ready="ready")
        scans = tried.heard(SCAN, SCAN_TYPE, count=6)
    finally:
        tried.stop("gz sim")
        tried.stop(BRIDGE)
    frame, rays = scans[-1].header.frame_id, len(scans[-1].ranges)
    around = scans[-1].angle_max - scans[-1].angle_min
    rate = (len(scans) - 1) / (_seconds(scans[-1]) - _seconds(scans[0]))
    expect(frame == "lidar_link", f"The frame of a scan is `{frame}`; `lidar_link` is wanted, as in /tf.")
    expect(rays >= 180, f"A scan has {rays} rays; 180 are wanted.")
    expect(around > 6.2, f"The rays span {around:z.2f} rad; all around is wanted.")
    expect(abs(rate - 10) < 1, f"There are {rate:z.1f} scans a second; 10 are wanted.")
    near = sum(each < CLEAR for each in scans[-1].ranges)
    expect(near < 0.02 * rays, f"{near} of {rays} rays end within {CLEAR} m: the lidar sees its own robot.")
    return f"{rate:z.0f} scans a second with {rays} rays all around, in the frame `{frame}`."


@step("joints", objective=3, form="joints.yaml")
def joints(tried: Tried) -> str:
    """A bridge with this file brings the states of both wheels to /joint_states, and so to /tf."""
    tried.stop(BRIDGE)
    try:
        tried.start(f"{BRIDGE} --ros-args -p config_file:=joints.yaml", ready="ready")
        state = tried.heard("/joint_states", "sensor_msgs/msg/JointState", deadline=5.0)[0]
        frames = tried.heard("/tf", "tf2_msgs/msg/TFMessage", deadline=5.0)[0]
    finally:
        tried.stop(BRIDGE)
    names = sorted(state.name)
    expect(names == ["left_wheel_joint", "right_wheel_joint"], f"/joint_states has {', '.join(names) or 'no joint'}.")
    moved = ", ".join(sorted(each.child_frame_id for each in frames.transforms))
    return f"/joint_states has {' and '.join(names)}, and /tf has {moved}."


@step("arguments", objective=4, form="scout.launch.py")
def arguments(tried: Tried) -> str:
    """The launch file has two arguments: the world, and x of the robot."""
    tried.stop("ros2 launch")
    tried.stop("gz sim")
    try:
        tried.start("ros2 launch scout.launch.py world:=shapes.sdf x:=2", ready="Entity creation successful")
        shapes = any(topic.startswith("/world/shapes/") for topic in tried.gz_topics())
        expect(shapes, "With world:=shapes.sdf another world runs.")
        pose = tried.poses("scout")[-1]
    finally:
        tried.stop("ros2 launch")
    seen = f"With x:=2 the robot is at x {pose.x:z.2f} m, y {pose.y:z.2f} m"
    expect(abs(pose.x - 2) < 0.1 and abs(pose.y) < 0.1, f"{seen}; x 2 m and y 0 m are wanted.")
    return f"{seen}, in the world of shapes.sdf."


def _seconds(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec / 1e9)


def _last(output: str) -> str:
    """Return the last line that a program printed."""
    lines = output.strip().splitlines()
    return lines[-1].strip() if lines else "nothing"
