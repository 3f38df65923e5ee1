"""The world seen from above: things where they were, at a scale one can read, and never a number that is none."""

import math
import re
from xml.etree import ElementTree as XML

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.report.html.from_above import Map
from gz_course.tests.grader.report.handmade import write_run

pytestmark = pytest.mark.usefixtures("without_blueprint")


@pytest.fixture
def seen(tmp_path):
    return Map(Recording(write_run(tmp_path / "run.rrd")), "robot")


def drawn(world, at, **options):
    return XML.fromstring(world.draw(at, 400, "a map", **options))


def centre(polygon):
    corners = [tuple(map(float, pair.split(","))) for pair in polygon.get("points").split()]
    return tuple((min(v) + max(v)) / 2 for v in zip(*corners, strict=True))


def test_the_robot_moves_to_the_right_and_the_box_stays(seen):
    start, end = (drawn(seen, at) for at in (0.0, 4.0))
    (box, robot), (same, later) = (map(centre, picture.findall("polygon")) for picture in (start, end))
    assert box == same
    assert later[0] > robot[0] and later[1] == pytest.approx(robot[1])
    assert box[1] < robot[1], "larger y lies higher"
    ruler = next(p for p in start.findall("path") if p.get("class") == "ruler")
    left, right = (float(v) for v in re.findall(r"[MH](-?[\d.]+)", ruler.get("d")))
    length = float(next(t.text for t in start.findall("text") if t.text.endswith(" m")).removesuffix(" m"))
    assert (later[0] - robot[0]) / (right - left) * length == pytest.approx(2.0, rel=0.02), "it went two metres"


def test_the_path_so_far_and_the_whole_path(seen):
    def path(picture):
        lines = picture.findall("polyline")
        return len(lines[0].get("points").split()) if lines else 0

    assert [path(drawn(seen, at)) for at in (0.0, 2.0, 4.0)] == [0, 21, 41]
    whole = drawn(seen, 0.0, whole_path=True)
    assert path(whole) == 41
    assert "start" in [text.text for text in whole.findall("text")]


def test_the_lidar_sees_from_where_the_robot_is(seen):
    def dots(at):
        (scan,) = [p for p in drawn(seen, at).findall("path") if p.get("class") == "scan"]
        return [float(x) for x in re.findall(r"M(-?[\d.]+) ", scan.get("d"))]

    assert len(dots(0.0)) == 2
    assert dots(4.0)[0] > dots(0.0)[0]


def test_it_says_in_words_what_it_shows(seen):
    assert seen.told().startswith("Seen from above: the robot goes from x = 0.00 m, y = 0.00 m to x = 2.00 m")
    assert seen.where(2.0) == "x = 1.00 m, y = 0.00 m, heading 0°"
    assert drawn(seen, 0.0).get("aria-label") == "a map"


def test_nothing_to_draw(tmp_path):
    empty = Map(Recording(write_run(tmp_path / "run.rrd", world=False, lines=[(0, "x")])), "robot")
    assert not empty
    assert empty.where(1.0) == ""
    assert drawn(empty, 0.0).findall("polygon") == []


def test_a_large_world_is_shown_around_the_path(tmp_path):
    import rerun as rr

    with Recorder(tmp_path / "large.rrd", "robot") as recorder:
        recorder.static("/world/field/link/visual", rr.Boxes3D(half_sizes=[[500, 500, 1]]))
        for second in range(3):
            recorder.set_time(second * 10**9)
            for axis in ("x", "y", "yaw"):
                recorder.scalar(f"truth/robot/{axis}", float(second))
    picture = drawn(Map(Recording(tmp_path / "large.rrd"), "robot"), 0.0, whole_path=True)
    xs = [float(pair.split(",")[0]) for pair in picture.find("polyline").get("points").split()]
    assert max(xs) - min(xs) > 100, "pixels: the path fills a good part of the picture"


anything = st.floats(-1e300, 1e300) | st.sampled_from([0.0, math.inf, -math.inf])


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(anything, anything, st.floats(-1e3, 1e3)), min_size=1, max_size=5), anything)
def test_a_robot_that_was_thrown_anywhere_can_be_drawn(tmp_path, rows, at):
    with Recorder(tmp_path / "wild.rrd", "robot") as recorder:
        for number, (x, y, yaw) in enumerate(rows):
            recorder.set_time(number * 10**9)
            for name, value in {"x": x, "y": y, "yaw": yaw, "distance": abs(x)}.items():
                recorder.scalar(f"truth/robot/{name}", value)
    world = Map(Recording(tmp_path / "wild.rrd"), "robot")
    for picture in (drawn(world, 1.0), drawn(world, 9.0, whole_path=True)):
        assert not re.search("nan|inf", XML.tostring(picture, encoding="unicode"))
    assert world.told() and world.where(0.5)
