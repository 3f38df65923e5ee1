"""What is counted, how long a leg takes, where the robot goes after the last waypoint, and which distances are said."""

import numpy as np
import pytest

from gz_course.tests.exercises.patrols import POINTS, STEP, Patrol, cancelled, found


@pytest.mark.parametrize(
    ("visited", "suspects", "words"),
    [
        (0, (), "visited is 0, but the robot had been at 1 of the waypoints when it was cancelled: the result"),
        (2, (), "and drove to the next: a waypoint counts when the robot has come to it"),
        (2, ({"line": 7, "about": "counted", "said": "so it is"},), "when it was cancelled: line 7: so it is"),
    ],
)
def test_a_cancelled_patrol_that_counts_wrongly(visited, suspects, words):
    patrol = Patrol([[1.2, 0.0], [1.2, 0.0001]])
    assert words in cancelled(patrol, visited=visited, suspects=suspects).explanation
    assert cancelled(Patrol([[1.2, 0.0], [1.2, 0.0001]]), visited=1).passed


def test_a_cancelled_robot_that_drives_home_first():
    finding = cancelled(Patrol([[1.2, 0.0], [1.2, 0.4], [0.0, 0.0]]), visited=1)
    assert "away from its waypoints, to (0.0, 0.0)" in finding.explanation, finding


def test_a_cancelled_robot_that_turns_on():
    patrol = Patrol([[1.2, 0.0], [1.2, 0.0001]], after=0.0)
    patrol.signals["truth/robot/angular_z"] = np.where(patrol.times > 4.6, 0.5, 0.0)
    assert not cancelled(patrol, visited=1).passed


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ([[1.0, 0.0], [1.0, 1.0]], "rounded to whole metres"),
        ([[1.0, 0.0]], "cut to whole metres"),
    ],
)
def test_coordinates_that_lost_their_fraction(places, words):
    assert words in found("visits", Patrol(places)).explanation
    assert "whole metres" not in found("visits", Patrol([[1.2, 0.0], [1.2, 0.4]])).explanation


def test_a_distance_that_a_server_believes():
    patrol = Patrol([[1.2, 0.0], [2.2, 0.0]], status="").feedback(np.hypot)
    for at, event, _, said in patrol.events:
        if event == "feedback":
            way, point = patrol.way[round(at / STEP)], np.array(POINTS[said["waypoint"]])
            said["distance"] = float(np.hypot(*(point - np.round(way))))
    words = "the distance that your server says is how far it is from the place of the robot, rounded"
    assert words in found("visits", patrol).explanation


def test_a_leg_that_is_over_after_the_same_time():
    patrol = Patrol([[0.8, 0.0], [0.8, 0.8]]).feedback(np.hypot)
    assert "goes on to the next waypoint 2.0 s after it has set out" in found("visits", patrol).explanation
    patrol = Patrol([[0.9, 0.0], [1.2, 0.4]]).feedback(np.hypot)
    assert "goes on to the next waypoint" not in found("visits", patrol).explanation


def test_a_patrol_that_goes_round():
    patrol = Patrol([*POINTS, POINTS[0]], visited=3)
    assert "drives on to the first waypoint again" in found("result", patrol).explanation
    home = Patrol([*POINTS, [0.0, 0.0]], visited=3)
    assert "drives on back to where the patrol began" in found("result", home).explanation


def test_commands_that_come_seldom():
    patrol = Patrol([[1.2, 0.0], [2.4, 0.4]], status="")
    patrol.signals["topics/cmd_vel/linear/x"] = patrol.signals["topics/cmd_vel/linear/x"][:1]
    times = np.arange(0, patrol.end, 1.2)
    signal = patrol.signal

    def seldom(name):
        values = np.full(len(times), 0.4)
        return type(signal(name))(np.round(times * 1e9).astype(np.int64), values) if "cmd_vel" in name else signal(name)

    patrol.signal = seldom
    assert "sends a command every 1.2 s only" in found("visits", patrol).explanation


def test_a_second_goal_that_waits_is_named_with_its_line():
    patrol = Patrol()
    patrol.events += [(2.0, "sent", "second", {"waypoints": POINTS, "speed": 0.2}), (2.0, "accepted", "second", {})]
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "queued", "said": "a goal waits here"}]}
    assert "which it must reject; line 7: a goal waits here" in found("busy", patrol).explanation


def braked(speeds, until=4.9):
    """Return the finding on a patrol that is cancelled at 4 s, with commands of these speeds [m/s] from then on."""
    patrol = Patrol([[1.2, 0.0], [1.2, 2.0]])
    patrol.end = until
    times = np.concatenate((np.arange(1.0, 4.05, 0.1), 4.1 + 0.1 * np.arange(len(speeds))))
    sent, signal = np.concatenate((np.full(31, 0.3), speeds)), patrol.signal

    def commanded(name):
        return type(signal(name))(np.round(times * 1e9).astype(np.int64), sent) if "cmd_vel" in name else signal(name)

    patrol.signal = commanded
    return cancelled(patrol, visited=1).explanation


def test_why_a_cancelled_robot_stops_late_is_seen():
    assert "it brakes little by little" in braked(np.linspace(0.3, 0.0, 8))
    assert "no command came for 0.9 s, so the robot obeyed the old one" in braked([])
    assert "too seldom" not in braked(np.full(8, 0.3))


def test_a_result_that_cannot_be_sent():
    patrol = Patrol(status="")
    patrol.facts = lambda: {"suspects": [{"line": 7, "about": "unsent_result", "said": "so it is"}]}
    patrol.signals["topics/cmd_vel/linear/x"] = patrol.signals["topics/cmd_vel/linear/x"][: round(patrol.end / STEP)]
    assert "no result came: line 7: so it is" in found("result", patrol).explanation


def test_a_robot_that_turns_to_one_side_only():
    patrol = Patrol([[1.2, 0.0], [1.2, 0.0001]], status="")
    patrol.times = np.arange(200) * STEP
    rest = 200 - len(patrol.way)
    patrol.signals = {name: np.append(values, np.full(rest, values[-1])) for name, values in patrol.signals.items()}
    patrol.signals["truth/robot/yaw"][-150:] = 2.6
    patrol.signals["topics/cmd_vel/angular/z"] = np.where(patrol.times > 2.0, 0.3, 0.0)
    assert "angular.z is never negative" in found("visits", patrol).explanation


def test_a_patrol_that_begins_with_the_speed_of_the_one_before():
    patrol = Patrol(speed=0.3)
    patrol.events = [
        (0.1, "interface", "", {"fault": ""}),
        (0.2, "sent", "patrol", {"waypoints": POINTS, "speed": 0.4}),
        (0.3, "accepted", "patrol", {}),
        (0.9, "result", "patrol", {"status": "SUCCEEDED", "visited": 2}),
        (0.95, "sent", "cancelled", {"waypoints": POINTS, "speed": 0.3}),
        (1.0, "accepted", "cancelled", {}),
    ]
    for name in ("topics/cmd_vel/linear/x", "truth/robot/linear_x"):
        patrol.signals[name][:24] = 0.4
    assert "begins a patrol with the speed of the one before, 0.40 m/s" in found("speed", patrol).explanation


def test_a_server_that_counts_other_places_is_not_told_to_count_otherwise():
    patrol = Patrol([[0.2, 0.0], [0.2, 1.5]])
    patrol.events[1:3] = []
    patrol.events += [
        (0.9, "sent", "cancelled", {"waypoints": POINTS, "speed": 0.4}),
        (1.0, "accepted", "cancelled", {}),
    ]
    patrol.events += [
        (0.2, "sent", "patrol", {"waypoints": [[3.0, 0.0]], "speed": 0.4}),
        (0.3, "accepted", "patrol", {}),
    ]
    patrol.events = [each for each in patrol.events if each[1] != "result" and each[:2] != (patrol.end + 0.5, "sent")]
    patrol.events += [
        (3.0, "result", "patrol", {"status": "SUCCEEDED", "visited": 1}),
        (4.0, "cancel", "cancelled", {}),
    ]
    patrol.events.append((patrol.end, "result", "cancelled", {"status": "CANCELED", "visited": 1}))
    finding = found("cancel", patrol)
    assert not finding.passed and "a waypoint counts when" not in finding.explanation, finding
