"""`final_pose`: circles, boxes, headings, moments."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import ManifestError


@pytest.fixture
def stood(record):
    def make(x, y, yaw=0.0, **more):
        rows = {"x": x, "y": y, "z": 0.1, "yaw": yaw}
        return record({f"truth/robot/{k}": [(0, -5.0), (7.5, value)] for k, value in rows.items()}, **more)

    return make


@pytest.mark.parametrize(("x", "passed"), [(2.0, True), (2.25, True), (2.26, False), (1.74, False)])
def test_a_circle(stood, found, x, passed):
    finding = found("final_pose", stood(x, 1.0), model="robot", near=[2.0, 1.0], radius=0.25)
    assert finding.passed is passed
    assert finding.measured == f"it stood at ({x:.2f}, 1.00), {abs(x - 2):.2f} m away"
    assert finding.expected == "robot: within 0.25 m of (2, 1) at 8 s"


@pytest.mark.parametrize(("y", "passed"), [(0.5, True), (1.5, True), (1.51, False)])
def test_a_box(stood, found, y, passed):
    assert found("final_pose", stood(2, y), model="robot", x=[1.5, 2.5], y=[0.5, 1.5]).passed is passed


def test_height_counts_where_it_is_asked_for(stood, found):
    assert not found("final_pose", stood(2, 1), model="robot", near=[2.0, 1.0, 1.0], radius=0.5).passed
    assert found("final_pose", stood(2, 1), model="robot", near=[2.0, 1.0, 0.4], radius=0.5).passed


@settings(deadline=None, max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.floats(-3, 3), st.integers(-3, 3), st.floats(-0.3, 0.3))
def test_a_full_turn_makes_no_difference(stood, found, heading, turns, off):
    finding = found(
        "final_pose", stood(0, 0, heading + off + turns * 2 * math.pi), model="robot", heading=heading, tolerance=0.2
    )
    assert finding.passed == (abs(off) <= 0.2) or abs(abs(off) - 0.2) < 1e-6


def test_another_moment(stood, found):
    assert not found("final_pose", stood(2, 1), model="robot", near=[2.0, 1.0], radius=0.5, at=7.0).passed


def test_a_run_that_broke_off_has_no_end(stood, found):
    finding = found("final_pose", stood(2, 1, facts={"sim_seconds": 7.9}), model="robot", near=[2.0, 1.0], radius=9.0)
    assert (finding.passed, finding.measured) == (False, "the simulation ended at 7.90 s")


def test_a_model_that_is_not_there(stood, found):
    assert (
        found("final_pose", stood(2, 1), model="rbot", near=[2.0, 1.0], radius=9.0).measured == "nothing is known of it"
    )


@pytest.mark.parametrize("wrong", [{}, {"near": [1.0]}, {"near": [1.0, 2.0]}, {"x": [1.0]}, {"heading": 1.0}])
def test_an_author_s_mistake(stood, found, wrong):
    with pytest.raises(ManifestError, match="check 'it'"):
        found("final_pose", stood(2, 1), model="robot", **wrong)
