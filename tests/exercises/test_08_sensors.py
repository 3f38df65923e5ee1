"""Wrong points, counts and stops in the hall are named by what they are."""

from importlib import import_module

import numpy as np
import pytest

from gz_course.grader.record.reading import Line, Poses, Signal

CHECKS = import_module("gz_course.exercises.08_sensors.grading.checks")
WORDS = import_module("gz_course.exercises.08_sensors.grading.misconceptions")
POSTS = {
    "red_1": (2.2, 0.15),
    "red_2": (-1.2, 2.0),
    "red_3": (-2.0, -1.4),
    "blue_1": (0.3, 1.45),
    "orange_1": (1.5, -1),
}
TURN = 8.0  # [s] from 1 s on


class Hall:
    """A recording of a robot that stands for a second, turns once, and drives to a post; and what its node said."""

    def __init__(self, points=lambda ahead, left: (ahead, left), count=3, sees=lambda names: names, stop=1.0):
        now = np.arange(0.0, 20.0, 0.04)
        yaw = np.clip((now - 1.0) / TURN, 0, 1) * 2 * np.pi
        driven = np.clip(now - 12.0, 0, 1) * (2.2 - 0.12 - 0.12 - stop)
        direction = np.arctan2(0.15, 2.2)
        yaw = np.where(now > 11.0, 2 * np.pi + direction, yaw)
        self.signals = {
            "truth/robot/x": (now, driven * np.cos(direction)),
            "truth/robot/y": (now, driven * np.sin(direction)),
            "truth/robot/yaw": (now, yaw),
            "truth/robot/distance": (now, driven),
            "truth/robot/angular_z": (now, np.where((now > 1) & (now < 1 + TURN), 2 * np.pi / TURN, 0)),
            "topics/cmd_vel/linear/x": (now, 0 * now),
            "topics/imu/angular_velocity/z": (now, np.gradient(yaw, now)),
        }
        self.end_ns, self.ended_s, self.frame = 20_000_000_000, 20.0, "camera_link"
        self.suspects = []
        at, said = [], []
        for t in np.arange(0.2, 10.0, 0.2):
            here = (0.0, 0.0, float(np.interp(t, now, yaw)))
            visible = {}
            for name, place in POSTS.items():
                ahead, left = CHECKS.before_camera(here, place)
                if ahead > 0.3 and abs(np.arctan2(left, ahead)) < 0.5 and name.startswith("red"):
                    visible[name] = points(ahead - CHECKS.RADIUS, left)
            for name in sees(list(visible)):
                at.append(t)
                said.append((*visible[name], 0.0))
        self.pictures = np.arange(0.2, 10.0, 0.2)
        said = np.array(said).reshape(-1, 3)
        self.signals |= {f"topics/red_post/point/{axis}": (at, said[:, i]) for i, axis in enumerate("xyz")}
        self.signals["topics/red_post/header/stamp"] = (at, at)
        self.signals["topics/red_post/count"] = (at, np.ones(len(at)))
        self.signals["topics/camera/image/header/stamp"] = self.signals["topics/camera/image/count"] = (
            self.pictures,
        ) * 2
        if count is not None:
            self.signals["topics/red_count/data"] = ([1 + TURN], [count])

    def signal(self, name):
        times, values = self.signals.get(name, (np.empty(0), np.empty(0)))
        return Signal(np.round(np.asarray(times) * 1e9).astype(np.int64), np.asarray(values, dtype=float))

    def entities(self, below, component=""):
        return [f"world/{name}" for name in POSTS]

    def poses(self, entity):
        x, y = POSTS[entity.removeprefix("world/")]
        return Poses(np.zeros(1), np.array([[x, y, 0.25]]), np.zeros((1, 4)))

    def lines(self, entity):
        return [Line(0, self.frame, "INFO")] if "red_post" in entity else []

    def properties(self, name):
        return {"duration": 20.0}

    def facts(self):
        return {"suspects": self.suspects}

    def found(self, name):
        return getattr(CHECKS, name)(self, {})


def test_a_right_run_passes():
    names = ("places_the_posts", "turns_once", "counts_the_posts", "stops_before_the_post")
    assert [Hall().found(name).passed for name in names] == [True] * 4


@pytest.mark.parametrize(
    ("hall", "words"),
    [
        (Hall(lambda a, b: (a, b / a)), "it lacks the factor ahead"),
        (Hall(lambda a, b: (a, b / a**2)), "it is divided by ahead, and must be multiplied by it"),
        (Hall(lambda a, b: (a, b * a)), "it has the factor ahead twice"),
        (Hall(lambda a, b: (a, b + 0.5 * a)), "for each metre ahead: the column is counted from about column 138"),
        (Hall(lambda a, b: (a, b - 0.171 * a)), "is counted from column 60, half of the height"),
        (Hall(lambda a, b: (1.0, b / a)), "every distance is 1.00 m"),
        (Hall(lambda a, b: (1.5 * a, 1.5 * b)), "the distances are 1.50 times the right ones"),
        (Hall(lambda a, b: (a, 0.0)), "point.y is always 0"),
        (
            Hall(lambda a, b: (a, 0.175 * a)),
            "in all points, wherever the post is: the column does not count in it, and",
        ),
        (Hall(lambda a, b: (a, -0.3 * a)), "point.y is -0.30 times point.x in all points"),
        (Hall(lambda a, b: (b, a)), "x and y are exchanged"),
        (Hall(lambda a, b: (0.0, 0.0)), "every point is at (0, 0)"),
        (Hall(sees=lambda names: [name for name in names if name != "red_3"]), "the farthest, 2.4 m away"),
        (Hall(sees=lambda names: names if names == ["red_1"] else []), "at least"),
    ],
)
def test_wrong_points_are_named(hall, words):
    finding = hall.found("places_the_posts")
    assert not finding.passed and words in finding.explanation + finding.expected, finding


@pytest.mark.parametrize("of_the_camera", [0.0, 0.12])
def test_points_that_are_turned_by_the_heading_are_named(of_the_camera):
    hall = Hall()
    now, yaw = hall.signals["truth/robot/yaw"]
    x = -0.1 * now  # it rolls back while it turns
    hall.signals["truth/robot/x"] = (now, x)
    points = []
    for at in np.arange(2.0, 9.0, 0.2):
        here = float(np.interp(at, now, x)), 0.0, float(np.interp(at, now, yaw))
        ahead, left = CHECKS.before_camera(here, POSTS["red_1"])
        ahead, heading = ahead - CHECKS.RADIUS + of_the_camera, here[2]
        points.append(
            (at, ahead * np.cos(heading) - left * np.sin(heading), ahead * np.sin(heading) + left * np.cos(heading))
        )
    times, *there = np.array(points).T
    for axis, values in zip("xyz", (*there, 0 * times), strict=True):
        hall.signals[f"topics/red_post/point/{axis}"] = (times, values)
    hall.signals["topics/red_post/header/stamp"] = (times, times)
    finding = hall.found("places_the_posts")
    assert "turned by the robot's heading" in finding.explanation, finding


@pytest.mark.parametrize(
    ("count", "words"),
    [
        (0, "self.posts is empty"),
        (5, "the number of all posts"),
        (1, "as many"),
    ],
)
def test_wrong_counts_are_named(count, words):
    finding = Hall(count=count).found("counts_the_posts")
    assert not finding.passed and (words in finding.explanation or count == 1), finding


def test_a_stop_at_the_wrong_place_is_named_unless_something_else_was_wrong_before():
    far = Hall(stop=1.4).found("stops_before_the_post")
    assert not far.passed and not far.gated and "too far away by 0.41 m" in far.explanation
    spoilt = Hall(stop=1.4, count=9).found("stops_before_the_post")
    assert not spoilt.passed and spoilt.gated and not spoilt.explanation


def test_a_robot_that_turns_on_and_on_is_told_the_line():
    hall = Hall(count=None)
    times, yaw = hall.signals["truth/robot/yaw"]
    hall.signals["truth/robot/yaw"] = (times, 3 * yaw)
    assert "your heading never reached a full turn" in hall.found("turns_once").explanation
    hall.suspects = [{"line": 52, "about": "gyroscope", "said": "a step counts for 0.01 s"}]
    assert hall.found("turns_once").explanation == "line 52: a step counts for 0.01 s"


def test_the_number_again_and_again():
    hall = Hall()
    hall.signals["topics/red_count/data"] = (9 + 0.1 * np.arange(20), np.full(20, 3.0))
    assert "comes again every 0.1 s" in hall.found("counts_the_posts").explanation


def test_rules_for_the_same_post():
    here = np.array([[2.0, 0.0], [0.0, 2.0], [2.0, 0.1], [0.0, 2.1]])
    told = {words.partition(":")[0]: number for words, number in WORDS.ways_to_count(here, here, np.zeros(4))}
    assert told["that is the number if points up to 3 m apart are one post"] == 1
    assert told["that is the number if points more than 0.05 m apart are two posts"] == 4
    assert (
        told["that is the number if each point is compared with the last one only, and not with all known posts"] == 4
    )
    assert told["that is the number if posts at the same distance are one"] == 1


def test_rules_of_different_kinds_that_give_the_same_number_are_not_said():
    one = ("that is the number if points up to 1 m apart are one post: x", 4)
    other = ("that is the number if points up to 2 m apart are one post: x", 4)
    third = ("that is the number of places if the points are not turned by the heading", 4)
    assert WORDS.the_only_one(4, [one, other]) == one[0]
    assert WORDS.the_only_one(4, [one, third]) == WORDS.the_only_one(5, [one]) == ""


@pytest.mark.parametrize(
    ("taken", "words"),
    [
        (lambda standing: standing.std(), "the standard deviation of the rates"),
        (lambda standing: standing.max(), "the largest of the rates"),
        (lambda standing: 0.5 * standing.mean(), "half of the mean"),
        (lambda standing: standing.mean(), ""),
    ],
)
def test_a_wrong_bias_is_told_from_when_the_heading_was_a_full_turn(taken, words):
    times = np.arange(0.0, 12.0, 0.04)
    turning = times > 1.0
    rates = np.where(turning, 0.8, 0.0) + 0.09 + 0.02 * np.random.default_rng(1).standard_normal(len(times))
    heading = np.cumsum(np.where(turning, (rates - taken(rates[~turning])) * 0.04, 0))
    until = heading < 2 * np.pi
    said = WORDS.turning.other_bias(times[until], rates[until], turning[until], 0.09)
    assert words in said and bool(words) == bool(said), said


def test_a_count_is_explained_by_the_line_that_keeps_the_posts():
    hall = Hall(count=4)
    hall.suspects = [{"line": 9, "about": "same", "said": "only the last one"}]
    assert hall.found("counts_the_posts").explanation == "line 9: only the last one"


def test_points_beside_the_posts_are_explained_by_the_line_that_takes_the_height_for_the_width():
    hall = Hall(lambda ahead, left: (ahead, left - 0.17 * ahead))
    hall.suspects = [{"line": 9, "about": "picture", "said": "the height is no width"}]
    assert hall.found("places_the_posts").explanation == "line 9: the height is no width"


def test_another_line_through_the_columns_is_named():
    hall = Hall(lambda a, b: (a, (117 - 80) / 80 * a + 117 / 80 * b * a / (a + CHECKS.RADIUS)))
    finding = hall.found("places_the_posts")
    assert not finding.passed
    assert "-(column - 117 (fx = k[0])) / 80 (cx = k[2]) * ahead" in finding.explanation, finding


def test_depths_taken_for_rays_are_not_taken_for_wrong_times():
    angles = np.tile([0.1, 0.3, -0.4, 0.45], 6)
    there = np.stack([2 + CHECKS.RADIUS + 0 * angles, (2 + CHECKS.RADIUS) * np.tan(angles)], axis=1)[:, None]
    said = WORDS.directions.of_rays(there, 2 * np.cos(angles), 2 * np.sin(angles))
    assert "multiplied by the cosine of the bearing" in said
    assert WORDS.directions.of_rays(there, 2 + 0 * angles, 2 * np.tan(angles)) == ""


def test_points_of_earlier_pictures():
    hall = Hall()
    for name in ("point/x", "point/y", "point/z", "header/stamp", "count"):
        times, values = hall.signals[f"topics/red_post/{name}"]
        later = np.asarray(times) + 2.0
        again = later if name == "header/stamp" else values
        hall.signals[f"topics/red_post/{name}"] = (np.append(times, later), np.append(values, again))
    finding = hall.found("places_the_posts")
    assert not finding.passed and "empty the list for each picture" in finding.explanation, finding


def test_stamps_of_no_picture_and_posts_that_are_left_out():
    hall = Hall()
    times, values = hall.signals["topics/red_post/header/stamp"]
    hall.signals["topics/red_post/header/stamp"] = (times, np.asarray(values) + 0.01)
    assert "header.stamp must be that of the picture" in hall.found("places_the_posts").explanation
    one = Hall(sees=lambda names: names[:1])
    there = np.array([POSTS["red_1"]] * 2)
    stamps = np.array([200_000_000, 400_000_000])
    POSTS["red_9"] = (1.9, -0.6)
    try:
        assert "not each of them got a point" in WORDS.directions.one_a_picture(one, there, stamps)
        both = np.array([POSTS["red_1"], POSTS["red_9"]] * 2)
        assert WORDS.directions.one_a_picture(one, both, np.repeat(stamps, 2)) == ""
    finally:
        del POSTS["red_9"]


def test_the_number_of_blue_posts_is_said_of_points_at_blue_posts_only():
    assert "blue" not in Hall(count=1).found("counts_the_posts").explanation


def test_a_robot_that_turns_while_the_bias_is_measured():
    hall = Hall(count=None)
    times = hall.signals["truth/robot/yaw"][0]
    hall.signals["truth/robot/yaw"] = (times, 0.8 * times)
    assert "degrees in the first 0.9 s already" in hall.found("turns_once").explanation


def test_rates_times_a_time_that_grows():
    times = np.arange(0.0, 4.0, 0.04)
    rates = np.where(times > 1.0, 0.8, 0.0)
    full = times[np.cumsum(rates * times) >= 2 * np.pi][0]
    assert "time since one and the same message" in WORDS.turning.since_the_first(times, rates, full * 1e9)
    assert WORDS.turning.since_the_first(times, rates, 9e9) == ""


def test_a_robot_that_backs_away_from_the_post():
    hall = Hall()
    times = hall.signals["truth/robot/x"][0]
    hall.signals["truth/robot/x"] = (times, np.where(times > 12, -0.1 * (times - 12), 0))
    hall.signals["truth/robot/distance"] = (times, np.where(times > 12, 0.1 * (times - 12), 0))
    hall.signals["truth/robot/linear_x"] = (times, np.where(times > 12, -0.1, 0))
    assert "it drives backwards" in hall.found("stops_before_the_post").explanation


def test_a_robot_that_turns_the_long_way_to_the_post():
    hall = Hall(stop=0.5)
    times, yaw = hall.signals["truth/robot/yaw"]
    assert CHECKS.stopping.turned_far(hall) == ""
    hall.signals["truth/robot/yaw"] = (times, np.where(times > 11.0, yaw - 2 * np.pi, yaw))
    assert "after the number came it turned by 356 degrees" in CHECKS.stopping.turned_far(hall)


def test_points_where_no_post_stands_are_put_down_to_walls_only_if_they_lie_there():
    hall = Hall(lambda a, b: (0.4, 0.4))
    assert "walls or floor" not in hall.found("places_the_posts").explanation
    beside = Hall(lambda a, b: (0.5 + 0.3 * a, 0.5))
    beside.suspects = [{"about": "overflow", "line": 9, "said": "2 * green overflows"}]
    said = CHECKS.why_somewhere(beside, *_given(beside))
    assert "walls or floor count as red: line 9: 2 * green overflows" in said
    beside.suspects = []
    assert "walls" not in CHECKS.why_somewhere(beside, *_given(beside))


def _given(hall):
    points, stamps, _ = CHECKS.said_points(hall)
    return points, stamps, np.zeros(len(points), bool)


@pytest.mark.parametrize(("about", "words"), [("axes", "line 9: atan2(ahead, left)"), ("", "check the signs of sin")])
def test_directions_that_are_exchanged_make_as_many_places_as_headings_of_the_other_sign(about, words):
    hall = Hall()
    hall.suspects = [{"line": 9, "about": about, "said": "atan2(ahead, left)"}] if about else []
    when = 9_000_000_000
    hall.signals["topics/red_count/data"] = ([9.0], [WORDS.hall.found_if(hall, when, -1.0)])
    assert words in hall.found("counts_the_posts").explanation


def test_a_list_that_stays_empty_by_its_own_rule():
    hall = Hall(count=0)
    assert "self.posts is empty" in hall.found("counts_the_posts").explanation
    hall.suspects = [{"line": 9, "about": "same", "said": "any(...) holds as soon as one known post is far away"}]
    assert hall.found("counts_the_posts").explanation.startswith("line 9: any(...)")
