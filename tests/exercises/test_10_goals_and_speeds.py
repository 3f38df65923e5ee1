"""Goals that are accepted wrongly, waypoints that are passed or left over, and speeds, in patrols of `10_actions`."""

import numpy as np
import pytest

from gz_course.tests.exercises.patrols import POINTS, STEP, Patrol, found


def accepted(*goals, status="CANCELED", suspects=()):
    """Return the finding on a server that accepts goals which it must reject, and ends them with a status."""
    patrol = Patrol().feedback(np.hypot)
    for goal in ("empty", "too_fast", "backwards", "standing"):
        patrol.events.append((0.3, "sent", goal, {"waypoints": POINTS, "speed": 0.4}))
        patrol.events.append((0.4, "accepted" if goal in goals else "rejected", goal, {}))
        if goal in goals:
            patrol.events.append((0.5, "result", goal, {"status": status, "visited": 0}))
    patrol.facts = lambda: {"suspects": list(suspects)}
    patrol.properties = lambda entity: {"trial_parameters": '{"parameters": {"server": {"max_speed": 0.35}}}'}
    return found("rejects", patrol).explanation


def test_goals_that_are_accepted_wrongly_are_named():
    every = ("empty", "too_fast", "backwards", "standing")
    assert accepted(*every) == "Your server accepts every goal, also those that cannot be done"
    late = accepted(*every, status="ABORTED")
    assert "ends them as ABORTED, which is too late: a goal is rejected in goal_callback" in late
    assert accepted("too_fast") == "Your server accepts 0.4 m/s where max_speed is 0.35"
    place = {"line": 9, "about": "accepts_empty", "said": "so it is"}
    assert accepted("empty", suspects=[place]).endswith("a goal without waypoints: line 9: so it is")
    assert "so it is" not in accepted("standing", suspects=[place])


def test_a_patrol_that_drives_to_a_waypoint_of_the_cancelled_one():
    def with_detour(way):
        patrol = Patrol(way)
        patrol.events = [each for each in patrol.events if each[2] != "patrol"]
        for goal, points in (("patrol", [[0.0, 0.0]]), ("cancelled", [[0.0, 1.0]])):
            patrol.events += [(0.2, "sent", goal, {"waypoints": points, "speed": 0.4}), (0.2, "accepted", goal, {})]
            patrol.events.append((0.5, "result", goal, {"status": "CANCELED", "visited": 0}))
        patrol.events += [(0.3, "rejected", "second", {}), (1.0, "accepted", "again", {})]
        patrol.events.append((1.0, "sent", "again", {"waypoints": [[1.0, 0.0]], "speed": 0.4}))
        patrol.events.append((patrol.end, "result", "again", {"status": "SUCCEEDED", "visited": 1}))
        return found("busy", patrol)

    assert "drives to (0, 1), which is a waypoint of the cancelled one" in with_detour([[0.0, 1.0], [1, 0]]).explanation
    assert with_detour([[1.0, 0.0]]).passed


def test_a_robot_that_drives_straight_past_a_waypoint():
    finding = found("visits", Patrol([[1.2, 0.0], [2.2, 0.95]], status=""))
    assert "drives straight past the waypoint" in finding.explanation, finding


def test_a_robot_that_never_turns_again_has_a_reason_in_the_file():
    patrol = Patrol([[2.4, 0.0]], status="")
    patrol.facts = lambda: {"suspects": [{"line": 8, "about": "phase", "said": "so it is"}]}
    assert "never turns towards the waypoint: line 8: so it is" in found("visits", patrol).explanation


def test_a_server_that_drives_on_to_a_waypoint_that_was_reached():
    patrol = Patrol([[1.2, 0.0], [2.6, 0.0]], status="").feedback(np.hypot)
    for event in (each for each in patrol.events if each[1] == "feedback"):
        way = patrol.way[round(event[0] / STEP)]
        event[3].update(waypoint=0, distance=float(np.hypot(*(np.array(POINTS[0]) - way))))
    assert "from the waypoint 0, but your server drives on to it" in found("visits", patrol).explanation


def test_a_robot_that_drives_backwards():
    patrol = Patrol([[-1.2, 0.0]], status="", speed=0.4)
    for name in ("topics/cmd_vel/linear/x", "truth/robot/linear_x"):
        patrol.signals[name] = -patrol.signals[name]
    assert "drives backwards: linear.x of its commands is negative" in found("visits", patrol).explanation
    patrol.signals["truth/robot/linear_x"] = patrol.signals["truth/robot/linear_x"] * -1 / 3.6
    assert "drives backwards" in found("speed", patrol).explanation


def test_a_unit_of_the_speed_is_told_by_the_commands_not_by_a_robot_that_is_held_up():
    patrol = Patrol(speed=0.4 / 3.6)
    assert "km/h" in found("speed", patrol).explanation
    patrol.signals["topics/cmd_vel/linear/x"] = patrol.signals["topics/cmd_vel/linear/x"] * 3.6
    assert "km/h" not in found("speed", patrol).explanation


def test_commands_of_the_next_goal_are_none_of_the_one_before():
    patrol = Patrol(after=0.1)
    commands = patrol.signals["topics/cmd_vel/linear/x"].copy()
    commands[(patrol.times >= patrol.end) & (patrol.times < patrol.end + 0.49)] = 0.0
    patrol.signals["topics/cmd_vel/linear/x"] = commands
    assert "obeys the last command" in found("visits", patrol).explanation


def test_an_index_that_goes_on_without_the_robot():
    patrol = Patrol([[1.2, 0.0]]).feedback(lambda dx, dy: 0.05)
    assert "the loop over the waypoints has to go on" in found("visits", patrol).explanation
    patrol.events.append((patrol.end - 0.1, "feedback", "patrol", {"waypoint": 1, "distance": 0.05}))
    assert "its index goes on to the last one" in found("visits", patrol).explanation


@pytest.mark.parametrize("places", [[[1.2, 0.7]], [[0.01, 0.0]], [[1.2, 0.0], [1.2, 0.4]]])
def test_one_coordinate_that_is_enough_goes_before_guesses(places):
    patrol = Patrol(places)
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "one_axis", "said": "so it is"}]}
    assert "A waypoint counts as reached where the robot is not: line 7" in found("visits", patrol).explanation


def test_a_robot_at_the_last_waypoint_only():
    patrol = Patrol([[1.2, 0.7]])
    assert "drove to the last waypoint only" in found("visits", patrol).explanation
    patrol.events.append((1.2, "feedback", "patrol", {"waypoint": 0, "distance": 1.1}))
    patrol.events.append((2.0, "feedback", "patrol", {"waypoint": 1, "distance": 0.9}))
    assert "takes the waypoint 0 for reached although" in found("visits", patrol).explanation


@pytest.mark.parametrize(
    ("times", "indices", "words"),
    [
        ((1.1, 4.0), (0, 1), "once for each waypoint, when it begins, and not while the robot drives: line 7"),
        ((3.9, 5.5), (0, 1), "once for each waypoint, when it is reached, and not while the robot drives: line 7"),
        ((1.1,), (0,), "published once, when the patrol begins, and not while the robot drives: line 7"),
        ((1.1, 2.4, 3.7, 5.0), (0, 0, 0, 1), "too rare: 4 messages in 5 s, one every 1.3 s: line 7"),
        ((1.1, 1.2, 5.0), (0, 0, 1), "too rare: 3 messages in 5 s: line 7"),
        ((1.1, 1.2, 1.3, 1.4, 1.5, 5.0, 5.1), (0,) * 5 + (1, 1), "for more than a second at times: line 7"),
    ],
)
def test_when_feedback_comes_that_is_too_rare(times, indices, words):
    patrol = Patrol()
    patrol.events += [
        (at, "feedback", "patrol", {"waypoint": index, "distance": 0.5})
        for at, index in zip(times, indices, strict=True)
    ]
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "rare_feedback", "said": "so it is"}]}
    assert words in found("feedback", patrol).explanation


def test_a_patrol_that_ends_before_it_begins():
    patrol = Patrol([[0.01, 0.0]])
    assert "either the condition of the loop" in found("visits", patrol).explanation
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "inverted", "said": "so it is"}]}
    assert "before the robot had moved: line 7: so it is" in found("visits", patrol).explanation
