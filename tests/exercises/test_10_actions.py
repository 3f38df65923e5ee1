"""Wrong patrols are named: where the robot went, how fast, what its feedback says; a right patrol has none of it."""

import numpy as np
import pytest

from gz_course.tests.exercises.patrols import CHECKS, FROM, POINTS, STEP, Patrol, cancelled, found


def test_a_right_patrol_passes():
    patrol = Patrol().feedback(np.hypot)
    assert [found(name, patrol).passed for name in ("visits", "speed", "feedback", "result")] == [True] * 4


@pytest.mark.parametrize(
    ("patrol", "words"),
    [
        (Patrol([[0.0, 1.2], [0.7, 1.2]], status=""), "x and y of the waypoints are exchanged"),
        (Patrol([[1.2, 0.0], [1.2, -0.7]], status=""), "y of the waypoints has the wrong sign"),
        (Patrol([[1.2, 0.0], [2.4, 0.7]], status=""), "as seen from the one before"),
        (Patrol([[1.2, 0.0], [2.4, 0.7]]), "as seen from the one before"),
        (Patrol([[0.0, 1.2], [0.7, 1.2]]), "x and y of the waypoints are exchanged"),
        (Patrol([[1.2, 0.7], [1.2, 0.0]], status=""), "in the opposite order"),
        (Patrol([[1.2, 0.0], [1.2, 0.4]]), "counts a waypoint as reached too early"),
        (Patrol([[1.2, 0.0]]), "after the first waypoint"),
        (Patrol([[0.01, 0.0]]), "before the robot had moved"),
        (Patrol(after=0.1), "drives on when the patrol is over"),
    ],
)
def test_where_the_robot_went_is_named(patrol, words):
    finding = found("visits", patrol)
    assert not finding.passed and words in finding.explanation, finding


@pytest.mark.parametrize(
    ("speed", "words"),
    [(0.2, "linear.x is half of it"), (0.8, "twice as much"), (1.44, "km/h"), (0.3, "slower than the goal says")],
)
def test_another_speed_is_named(speed, words):
    finding = found("speed", Patrol(speed=speed))
    assert not finding.passed and words in finding.explanation, finding


@pytest.mark.parametrize(
    ("distance", "words"),
    [
        (lambda dx, dy: 0.0 * dx + dy * dy + dx * dx, "the square of how far it is"),
        (lambda dx, dy: 100 * np.hypot(dx, dy), "in centimetres"),
        (lambda dx, dy: -np.hypot(dx, dy), "negative"),
        (lambda dx, dy: np.abs(dy), "along y alone"),
    ],
)
def test_another_distance_is_named(distance, words):
    finding = found("feedback", Patrol().feedback(distance))
    assert not finding.passed and words in finding.explanation, finding


@pytest.mark.parametrize(
    ("waypoint", "words"),
    [(lambda i: 0, "is always 0"), (lambda i: 2 - i, "counts down"), (lambda i: i + 1, "counts the waypoints from 1")],
)
def test_another_index_is_named(waypoint, words):
    finding = found("feedback", Patrol().feedback(np.hypot, waypoint))
    assert not finding.passed and words in finding.explanation, finding


def test_the_index_of_the_last_waypoint_is_no_count():
    assert "the index of the last waypoint" in found("result", Patrol(visited=1)).explanation


def test_a_way_that_ends_elsewhere_is_no_return_in_the_loop():
    assert "a return, or a break" not in found("visits", Patrol([[1.2, 0.0], [1.9, -0.4]])).explanation


SUSPECTS = [
    {"line": 7, "about": "cancel", "said": "line 5 asks it once"},
    {"line": 3, "about": "result", "said": "self.result is made once"},
]


@pytest.mark.parametrize(
    ("status", "suspects", "words"),
    [
        ("SUCCEEDED", SUSPECTS, "drives on: line 7: line 5 asks it once"),
        ("SUCCEEDED", (), "drives on: the loop never asks"),
        ("CANCELED", (), "when the robot had come to a waypoint: goal_handle.is_cancel_requested is asked once per"),
    ],
)
def test_why_a_cancelled_robot_drives_on(status, suspects, words):
    finding = cancelled(Patrol(), status, suspects=suspects)
    assert not finding.passed and words in finding.explanation, finding


@pytest.mark.parametrize(
    ("visited", "suspects", "words"),
    [
        (2, (), "the 2 of the patrol before and 0 of this one"),
        (2, SUSPECTS, "goes on from goal to goal. line 3: self.result is made once"),
        (5, SUSPECTS, "but the robot had been at 0 of the waypoints"),
    ],
)
def test_a_count_that_goes_on_is_named(visited, suspects, words):
    finding = cancelled(Patrol([[1.0, 0.0]], speed=0.3), "CANCELED", visited, suspects=suspects)
    assert not finding.passed and words in finding.explanation, finding


def test_a_robot_that_turns_on_after_the_end():
    patrol = Patrol()
    patrol.signals["truth/robot/angular_z"] = 0.3 + 0 * patrol.times
    finding = found("visits", patrol)
    assert not finding.passed and "The robot turns on when the patrol is over" in finding.explanation


def test_a_command_for_each_waypoint_only():
    patrol = Patrol([[3.0, 0.0]], status="")
    patrol.signals["topics/cmd_vel/linear/x"] = np.full(21, 0.4)  # until the patrol begins, and once
    finding = found("visits", patrol)
    assert "Your server sent 1 command in" in finding.explanation


@pytest.mark.parametrize(
    ("about", "words"),
    [
        ("summed_place", "line 7: so it is"),
        ("old_pose", "steers by a place that the robot has left: line 7"),
        ("one_axis", "counts as reached where"),
    ],
)
def test_a_suspect_of_a_patrol_that_went_elsewhere(about, words):
    patrol = Patrol([[1.2, 0.0], [1.9, -0.4]], status="")
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": about, "said": "so it is"}]}
    assert words in found("visits", patrol).explanation


def test_a_waypoint_that_is_reached_by_reckoning():
    patrol = Patrol([[1.2, 0.0], [1.2, 0.4]])
    patrol.feedback(lambda dx, dy: max(0.0, np.hypot(dx, dy) - 0.3))
    assert "it counts time or steps" in found("visits", patrol).explanation


def test_a_loop_that_asks_for_more_than_the_task():
    patrol = Patrol(status="").feedback(np.hypot)
    patrol.events.append((patrol.times[-1], "feedback", "patrol", {"waypoint": 1, "distance": 0.06}))
    assert "its distance is still 0.060 m" in found("result", patrol).explanation


def later(waypoints, way, suspects=(), speed=0.4, answer="accepted"):
    """Let the patrol after the cancelled one be a goal for `waypoints`; the robot goes on along `way`."""
    patrol = Patrol(way)
    at = patrol.end - 2.0
    patrol.events = [each for each in patrol.events if each[2] != "patrol"]
    for goal, start in (("patrol", 0.2), ("cancelled", 0.5)):
        patrol.events += [(start, "sent", goal, {"waypoints": POINTS, "speed": 0.4}), (start, "accepted", goal, {})]
        patrol.events.append((start + 0.1, "result", goal, {"status": "SUCCEEDED", "visited": 2}))
    patrol.events += [(0.3, "rejected", "second", {}), (at, "sent", "again", {"waypoints": waypoints, "speed": speed})]
    patrol.events.append((at, answer, "again", {}))
    if answer == "accepted":
        patrol.events.append((patrol.end, "result", "again", {"status": "SUCCEEDED", "visited": 1}))
    patrol.facts = lambda: {"suspects": list(suspects)}
    patrol.properties = lambda entity: {}
    return found("busy", patrol)


@pytest.mark.parametrize(
    ("waypoints", "suspects", "words"),
    [
        ([[1.5, 0.0]], (), "turned with its heading"),
        ([[1.5, 0.0]], (), "seen from where the patrol begins"),
        ([[0.3, 0.1]], [{"line": 9, "about": "anew", "said": "self.route keeps"}], "spoils the next one: line 9"),
    ],
)
def test_a_later_patrol_that_goes_elsewhere(waypoints, suspects, words):
    turned = "turned" in words
    finding = later(waypoints, [[0.0, 2.0], [-2.0, 2.0]] if turned else [[0.0, 2.0], [2.0, 2.0]], suspects)
    assert not finding.passed and words in finding.explanation, finding


@pytest.mark.parametrize(
    ("about", "speed", "words"),
    [
        ("goal_length", 0.4, "rejects a goal with a single waypoint: line 9"),
        ("goal_limit", 0.5, "the speed 0.5, which is max_speed itself: line 9"),
        ("goal_limit", 0.4, "the flag that says it is busy"),
        ("", 0.4, "the flag that says it is busy"),
    ],
)
def test_a_later_goal_that_is_refused(about, speed, words):
    suspects = [{"line": 9, "about": about, "said": "so it is"}]
    assert words in later([[1.0, 1.0]], [[2.0, 0.0]], suspects, speed, "rejected").explanation


def test_a_later_patrol_that_is_at_its_end_and_goes_on():
    finding = later([[2.0, 0.0]], [[2.0, 0.0]])
    assert finding.passed
    patrol = Patrol([[2.0, 0.0]], status="")
    said = {"waypoint": 0, "distance": 0.02}
    patrol.events.append((patrol.times[-1], "feedback", "again", said))
    run = CHECKS.Run(patrol)
    assert "its distance is still 0.020 m" in CHECKS.still_driving(run, "again")


def with_a_second(patrol, answer, waypoint=(1.9, 0.5), speed=0.2, at=2.0):
    patrol.events.append((at, "sent", "second", {"waypoints": [list(waypoint)], "speed": speed}))
    patrol.events.append((at, answer, "second", {}))
    return patrol


def test_a_second_goal_that_ends_the_patrol_is_what_is_said():
    patrol = with_a_second(Patrol([[0.4, 0.0]], status="ABORTED"), "accepted", at=1.9)
    assert found("visits", patrol).gated
    assert "the patrol under way ended as ABORTED 0.1" in found("busy", patrol).explanation
    late = with_a_second(Patrol(), "accepted")
    assert found("visits", late).passed and not found("busy", late).explanation


def test_a_second_goal_to_which_the_robot_turns():
    taken = with_a_second(Patrol([[0.6, 0.0], [1.9, 0.5]], status=""), "accepted")
    assert "the robot left the patrol under way for its waypoint" in found("busy", taken).explanation
    refused = with_a_second(Patrol([[0.6, 0.0], [1.9, 0.5]], status=""), "rejected")
    assert "was rejected, but the robot drives to its waypoint" in found("visits", refused).explanation


def test_a_second_goal_that_stops_the_robot():
    patrol = with_a_second(Patrol([[0.4, 0.0]], status=""), "accepted", at=1.9)
    assert "the robot stopped then" in found("busy", patrol).explanation and found("visits", patrol).gated


def test_a_second_goal_after_which_nothing_is_said_of_the_first():
    patrol = with_a_second(Patrol([[4.0, 0.0]], status="").feedback(np.hypot), "accepted")
    patrol.events = [each for each in patrol.events if each[1] != "feedback" or each[0] < 2.1]
    assert "neither feedback nor a result of the patrol" in found("busy", patrol).explanation


def test_a_rejected_goal_whose_speed_is_taken():
    patrol = with_a_second(Patrol(), "rejected")
    assert found("speed", patrol).passed
    patrol.signals["truth/robot/linear_x"] = np.where(patrol.times > 2.2, 0.2, patrol.signals["truth/robot/linear_x"])
    assert "the robot goes on at its speed" in found("speed", patrol).explanation


def test_a_heading_in_degrees():
    patrol = Patrol([[1.2, 0.0], [3.2, 0.0]], status="")
    direction = np.arctan2(0.7 - patrol.way[:, 1], 1.21 - patrol.way[:, 0])
    patrol.signals["truth/robot/yaw"] = np.where(patrol.times > FROM, direction / 57.3, 0.0)
    patrol.signals["truth/robot/angular_z"] = 0.03 + 0 * patrol.times
    assert "its heading is in degrees" in found("visits", patrol).explanation


def test_a_robot_that_turns_past_the_waypoint():
    patrol = Patrol([[1.2, 0.0]], status="")
    after = np.arange(20) * 0.15
    patrol.signals["truth/robot/yaw"] = np.r_[patrol.signals["truth/robot/yaw"][:-20], after]
    patrol.signals["truth/robot/linear_x"] = np.where(patrol.times < patrol.end - 0.5, 0.4, 0.0)
    patrol.signals["truth/robot/angular_z"] = np.where(patrol.times < patrol.end, 0.0, 3.0)
    assert "turned past the waypoint" in found("visits", patrol).explanation


def test_a_place_that_is_kept_from_the_first_message():
    patrol = Patrol([[3.0, 0.0]], status="").feedback(lambda dx, dy: 1.2)
    assert "/odom needs a thread of its own" in found("visits", patrol).explanation
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "first_kept", "said": "so it is"}]}
    assert "where it was at first: line 7: so it is" in found("visits", patrol).explanation


def test_a_robot_that_misses_because_it_is_too_fast():
    patrol = Patrol([[1.2, 0.0], [1.9, 0.0]], speed=1.5).feedback(lambda dx, dy: 0.05)
    assert "drives at 1.50 m/s where the goal says 0.40" in found("visits", patrol).explanation


def test_a_robot_that_circles_around_the_waypoint():
    patrol = Patrol([[1.2, 0.0], [3.2, 0.0]], status="")
    patrol.signals["truth/robot/angular_z"] = 0.3 + 0 * patrol.times
    assert "but drives on although the waypoint is" in found("visits", patrol).explanation


def test_a_cancelled_goal_that_had_ended_before():
    patrol = Patrol()
    patrol.events += [
        (2.0, "sent", "cancelled", {"waypoints": POINTS, "speed": 0.3}),
        (2.0, "accepted", "cancelled", {}),
    ]
    ended = {"status": "SUCCEEDED", "visited": 0}
    patrol.events += [(2.1, "result", "cancelled", ended), (4.0, "cancel", "cancelled", {})]
    patrol.events.append((4.1, "not_cancelling", "cancelled", {}))
    finding = found("cancel", patrol)
    assert "refuses to cancel" not in finding.explanation and "before it was to be cancelled" in finding.measured


def test_what_is_said_of_the_end_is_seen():
    patrol = Patrol(after=0.1)
    assert "other than zero came after the end" in found("visits", patrol).explanation
    patrol.signals["topics/cmd_vel/linear/x"] = patrol.signals["topics/cmd_vel/linear/x"][: round(patrol.end / STEP)]
    assert "until it gets a Twist of zeros" in found("visits", patrol).explanation


def test_a_patrol_that_goes_on_until_the_end_has_no_missing_succeed():
    patrol = Patrol(status="")
    assert "commands still come" in found("result", patrol).explanation
    patrol.signals["topics/cmd_vel/linear/x"] = patrol.signals["topics/cmd_vel/linear/x"][: round(patrol.end / STEP)]
    assert "execute must call goal_handle.succeed()" in found("result", patrol).explanation


def test_a_distance_that_is_no_float():
    patrol = Patrol()
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "feedback", "said": "round(left) is a whole number"}]}
    assert "line 7: round(left)" in found("feedback", patrol).explanation
