"""`ros2 topic pub`, `bw`, `delay` and `find` against real nodes."""

import itertools
import os
import re
import signal
import threading

import pytest

DEADLINE = 120.0
CMD_VEL = "/robot/cmd_vel"
ASKED = {
    "find": ["find", "geometry_msgs/Twist"],
    "find count": ["find", "-c", "geometry_msgs/msg/Twist"],
    "find nothing": ["find", "sensor_msgs/msg/LaserScan"],
    "find unknown": ["find", "sensor_msgs/msg/LaserScn"],
    "delay without header": ["delay", CMD_VEL],
    "no type": ["pub", CMD_VEL, "geometry_msgs/msg/Twst"],
    "wrong field": ["pub", CMD_VEL, "geometry_msgs/msg/Twist", "{linaer: {x: 1}}"],
    "not yaml": ["pub", CMD_VEL, "geometry_msgs/msg/Twist", "{linear: "],
    "no dictionary": ["pub", CMD_VEL, "geometry_msgs/msg/Twist", "1.0"],
    "bad name": ["pub", "/cmd vel", "geometry_msgs/msg/Twist"],
    "bad node": ["pub", CMD_VEL, "geometry_msgs/msg/Twist", "-n", "1 2"],
    "typo": ["pub", "-1", "--max-wait-time-secs", "0.2", "/robot/cmd_vl", "geometry_msgs/msg/Twist"],
    "other type": ["pub", "-1", "--max-wait-time-secs", "0.2", CMD_VEL, "geometry_msgs/msg/TwistStamped"],
    "other qos": [
        *("pub", "-1", "--max-wait-time-secs", "0.2", "--qos-reliability", "best_effort"),
        *(CMD_VEL, "geometry_msgs/msg/Twist"),
    ],
    "rate 0": ["pub", CMD_VEL, "geometry_msgs/msg/Twist", "-r", "0"],
    "once and times": ["pub", CMD_VEL, "geometry_msgs/msg/Twist", "-1", "-t", "2"],
}


@pytest.fixture(scope="module")
def answers(robot, run_together):
    def run(names):
        return dict(zip(names, run_together(*(["topic", *ASKED[name]] for name in names)), strict=True))

    # The topics and types of the publishing commands must not be visible in the graph.
    publishing = [name for name in ASKED if ASKED[name][0] == "pub"]
    return run([name for name in ASKED if name not in publishing]) | run(publishing)


@pytest.fixture
def heard(robot):
    """Return the messages of /heard as they arrive, and a function that waits for a number of them."""
    from std_msgs.msg import Header

    messages, arrived = [], threading.Condition()

    def take(message):
        with arrived:
            messages.append(message)
            arrived.notify_all()

    subscription = robot.create_subscription(Header, "/heard", take, 10)

    def wait(count):
        with arrived:
            assert arrived.wait_for(lambda: len(messages) >= count, DEADLINE), messages
        return messages

    yield wait
    robot.destroy_subscription(subscription)


def test_find(answers):
    assert answers["find"] == (0, f"{CMD_VEL}\n", "")
    assert answers["find count"] == (0, "1\n", "")
    assert answers["find nothing"] == (0, "", "")


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ("find unknown", "The message type 'sensor_msgs/msg/LaserScn' is invalid; did you mean 'sensor_msgs/msg/Laser"),
        ("delay without header", "msg does not have header"),
        ("no type", "The message type 'geometry_msgs/msg/Twst' is invalid; did you mean 'geometry_msgs/msg/Twist'?"),
        ("wrong field", "Failed to populate field: Twist has no field 'linaer', its fields: linear, angular; did you"),
        ("not yaml", "The passed value is not YAML: line "),
        ("no dictionary", "The passed value needs to be a dictionary in YAML format"),
        ("bad name", "'/cmd vel' is not a topic name: "),
        ("bad node", "'1 2' is not a node name: "),
    ],
)
def test_what_cannot_be_is_one_sentence(answers, asked, sentence):
    code, text, errors = answers[asked]
    assert (code, text) == (1, "")
    assert errors.startswith(sentence)
    assert len(errors.splitlines()) == 1


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ("typo", "did you mean '/robot/cmd_vel'?"),
        ("other type", "its subscribers want geometry_msgs/msg/Twist, not geometry_msgs/msg/TwistStamped"),
        ("other qos", "its subscribers ask for another quality of service (reliable)"),
    ],
)
def test_nobody_who_can_listen_is_told_with_the_reason(answers, asked, why):
    code, text, errors = answers[asked]
    assert code == 1
    assert set(text.splitlines()) <= {"Waiting for at least 1 matching subscription(s)..."}
    assert errors.splitlines()[-1] == (
        f"Timed out waiting for subscribers: Expected 1 subscribers but only got 0 subscribers; {why}"
    )


def test_options_that_cannot_be_are_wrong_usage(answers):
    assert answers["rate 0"][0] == answers["once and times"][0] == 2


def test_once_sends_one_message_that_arrives(ros2, heard):
    code, text, errors = ros2("topic", "pub", "--once", "/heard", "std_msgs/Header", "{frame_id: map, stamp: {sec: 3}}")
    (message,) = heard(1)
    assert (message.frame_id, message.stamp.sec) == ("map", 3)
    assert (code, errors) == (0, "")
    assert text == f"publisher: beginning loop\npublishing #1: {message!r}\n\n"


def test_times_rate_print_and_the_time_of_sending(ros2, heard):
    options = ["-t", "4", "-r", "100", "-p", "2", "--stdin"]
    code, text, _ = ros2("topic", "pub", *options, "/heard", "std_msgs/msg/Header", stdin_text="stamp: now")
    stamps = [message.stamp.sec * 10**9 + message.stamp.nanosec for message in heard(4)]
    assert code == 0
    assert re.findall(r"publishing #(\d+)", text) == ["2", "4"]
    assert len(stamps) == 4
    assert all(later > earlier for earlier, later in itertools.pairwise(stamps))


def test_it_publishes_until_interrupted_as_the_node_it_is_told_to_be(start, robot, heard):
    command = start("topic", "pub", "-r", "50", "-n", "hand", "/heard", "std_msgs/msg/Header")
    heard(3)
    assert "hand" in robot.get_node_names()
    os.kill(command.process.pid, signal.SIGINT)
    code, _, errors = command.wait()
    assert (code, errors) == (2, "")


SECONDS = r"\d?\d\.\d{3}"  # a busy machine may take some


@pytest.mark.parametrize(
    ("verb", "first", "report"),
    [
        ("bw", "Subscribed to [/stamped]", r"\d+ B/s from \d+ messages\n\tMessage size mean: (\d+ B) min: \1 max: \1"),
        (
            "delay",
            "",
            rf"average delay: {SECONDS}\n\tmin: {SECONDS}s max: {SECONDS}s std dev: {SECONDS}\d\ds window: \d+",
        ),
    ],
)
def test_a_report_every_second(start, robot, verb, first, report):
    command = start("topic", verb, "/stamped")
    command.wait_for("min: ")
    os.kill(command.process.pid, signal.SIGINT)
    code, text, errors = command.wait()
    assert (code, errors) == (2, "")
    assert re.match(f"{re.escape(first)}\n?{report}\n", text), text
