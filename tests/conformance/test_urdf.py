"""URDF robots against libsdformat, which Gazebo reads them with: names, poses, masses, shapes, limits are the same.

Needs Debian's `libsdformat-dev` and `g++`; skipped where they are missing.
"""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose, matrix
from gz_course.sim.gz.sim.sdf.reader import read_model
from gz_course.tests.conformance.libsdformat import libsdformat
from gz_course.tests.conformance.random_robots import robots

NEEDS_CLIENT = False
TYPES = {"ball": 1, "continuous": 2, "fixed": 3, "prismatic": 5, "revolute": 6}


@pytest.fixture(scope="session")
def oracle(tmp_path_factory):
    with libsdformat("sdformat_reader.cc", tmp_path_factory.mktemp("oracle")) as read:
        yield read


def pose_of(numbers) -> Pose:
    return Pose(numbers[:3], numbers[3:])


def same(pose: Pose, numbers, what: str, tolerance: float = 1e-6) -> None:
    assert numbers is not None, what
    assert pose.is_close(pose_of(numbers), tolerance), (what, pose.position, pose.quaternion, numbers)


def size_of(geometry) -> list[float]:
    x, _, z = geometry.size
    return {"box": list(geometry.size), "sphere": [x / 2], "cylinder": [x / 2, z]}[geometry.kind]


def compare(model, wanted) -> None:
    assert [link.name for link in model.links] == [link["name"] for link in wanted["links"]]
    for link, other in zip(model.links, wanted["links"], strict=True):
        same(link.pose, other["pose"], link.name)
        inertial = link.inertial
        assert inertial.mass == pytest.approx(other["mass"], rel=1e-9)
        assert inertial.pose.position == pytest.approx(other["com"], abs=1e-6)
        ixx, iyy, izz, ixy, ixz, iyz = inertial.moments
        turn = matrix(inertial.pose.quaternion)
        tensor = turn @ np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))) @ turn.T
        assert tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]] == pytest.approx(other["inertia"], rel=1e-5, abs=1e-6)
        for kind in ("collisions", "visuals", "sensors"):
            ours, theirs = getattr(link, kind), other[kind]
            assert [part.name for part in ours] == [part["name"] for part in theirs]
            for part, expected in zip(ours, theirs, strict=True):
                # libsdformat writes the poses of lumped sensors with six digits.
                same(link.pose * part.pose, expected["pose"], part.name, 1e-4 if kind == "sensors" else 1e-6)
                if kind != "sensors":
                    assert size_of(part.geometry) == pytest.approx(expected["size"])
                if kind == "collisions":
                    assert part.mu == pytest.approx(expected["mu"])
                if kind == "visuals" and expected["diffuse"] is not None and not expected["script"]:
                    assert part.rgba == pytest.approx(expected["diffuse"], abs=1e-6)
    assert [joint.name for joint in model.joints] == [joint["name"] for joint in wanted["joints"]]
    for joint, other in zip(model.joints, wanted["joints"], strict=True):
        assert (TYPES[joint.kind], joint.parent, joint.child) == (other["type"], other["parent"], other["child"])
        child = model.link(joint.child)
        same(child.pose * joint.pose, other["pose"], joint.name)
        if joint.kind == "fixed":
            continue
        axis = joint.axis
        x, y, z, lower, upper, effort, _velocity, damping, friction, stiffness, reference = other["axis"]
        assert matrix(child.pose.quaternion) @ axis.direction == pytest.approx((x, y, z), abs=1e-7)
        assert (axis.lower, axis.upper) == pytest.approx((lower, upper))
        assert min(axis.effort, 1e308) == pytest.approx(effort)
        ours = (axis.damping, axis.friction, axis.spring_stiffness, axis.spring_reference)
        assert ours == pytest.approx((damping, friction, stiffness, reference))


def check(oracle, folder: Path, text: str) -> None:
    path = folder / "robot.urdf"
    path.write_text(text)
    wanted = oracle(path)
    assert wanted["model"] is not None, wanted["errors"]
    compare(read_model(text, str(path), Diagnostics(strict=True)), wanted["model"])


# A robot is never made smaller after a failure: that takes minutes, and the difference tells enough.
PHASES = (Phase.explicit, Phase.reuse, Phase.generate)


@settings(deadline=None, max_examples=60, suppress_health_check=list(HealthCheck), phases=PHASES)
@given(robots())
def test_random_robots_are_what_gazebo_makes_of_them(oracle, tmp_path, text):
    check(oracle, tmp_path, text)
