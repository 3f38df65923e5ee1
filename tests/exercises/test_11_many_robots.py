"""The checks of `11_many_robots`: what a follower with a misconception sends is named, and where robots stand."""

from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.grader.record.reading import Signal
from gz_course.tests.exercises.convoys import (
    CHECKS,
    FITS,
    GAP,
    TOPICS,
    Run,
    bearing,
    distance,
    place,
    rule,
    speed_of,
    told,
    wrapped,
)


def place_ahead(h, begins):
    x, y = place(h, begins)
    return np.cos(h.heading) * x + np.sin(h.heading) * y


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_a_good_follower_has_no_misconception(delay):
    assert told(rule(), "speed", delay) == "" and told(rule(), "turning", delay) == ""


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        (lambda h: 0.5, "linear.x 0.50 m/s all the time"),
        (lambda h: 0.0, "made of gap - distance"),
        (lambda h: speed_of(distance(h) - 2 * GAP), "zero at a distance of 2.40 m"),
        (lambda h: speed_of(distance(h)), "it drives on where the distance is the gap"),
        (lambda h: speed_of(distance(h) - GAP, gain=0.3), "its gain is too small"),
        (lambda h: speed_of(distance(h) - GAP, most=0.3), "never drives faster than 0.30 m/s"),
        (lambda h: speed_of(distance(h) - GAP, least=0.2), "never drives slower than 0.20 m/s"),
        (lambda h: speed_of(np.hypot(h.front_x - h.x, h.front_y - h.y) - GAP), "begins where its own robot began"),
        (lambda h: h.v, "its speed is that of the robot in front"),
        (lambda h: speed_of(distance(h) - GAP, most=900.0, gain=1000.0), "linear.x is in metres per second"),
        (lambda h: -speed_of(distance(h) - GAP), "the sign of its speed is wrong"),
        (lambda h: -0.2 - speed_of(h.x * 0), "all the time"),
        (lambda h: speed_of(place_ahead(h, 2.4)), "to have begun 2.4 m ahead"),
        (lambda h: speed_of(np.hypot(*place(h))), "which has no sign: beyond that place it drives on"),
        (lambda h: speed_of(np.hypot(h.front_y - h.x, h.front_x + GAP - h.y) - GAP), "exchanges x and y"),
        (lambda h: speed_of(np.hypot(h.front_x + 2.4 - h.x, h.aside) - GAP), "to have begun 2.4 m ahead"),
        (lambda h: speed_of(np.hypot(h.front_x - h.x, h.front_y + GAP - h.y) - GAP), "adds the 1.2 m to y"),
        (lambda h: speed_of(np.hypot(h.v + GAP - h.x, h.y) - GAP), "takes the speed of the robot in front, twist"),
    ],
)
def test_a_wrong_speed_is_explained(speed, words):
    assert words in told(rule(speed), "speed")


@pytest.mark.parametrize(
    ("angle", "words"),
    [
        (bearing, "does not subtract its own heading"),
        (lambda h: bearing(h) + h.heading, "adds its own heading"),
        (lambda h: np.arctan2(h.ahead, h.aside) - h.heading, "exchanges the arguments of atan2"),
        (lambda h: wrapped(h.heading - bearing(h)), "the sign of angular.z is wrong"),
        (lambda h: wrapped(bearing(h) - h.front_heading), "subtracts the heading of the robot in front"),
        (lambda h: wrapped(bearing(h) + np.pi - h.heading), "the direction is turned by pi"),
        (lambda h: h.w / 2, "sends the turning rate of the robot in front"),
    ],
)
def test_a_wrong_angle_is_explained(angle, words):
    assert words in told(rule(angle=angle), "turning")


def test_a_follower_that_sends_too_little_is_not_judged():
    run = Run(rule())
    run.signals = {name: (times[:5], values[:5]) for name, (times, values) in run.signals.items()}
    assert FITS.heard(run, "robot2", "robot1") == [] and FITS.heard(run, "robot3", "robot2") == []


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ([(0, 0), (1.2, 0), (2.4, 0)], "in front of the one before"),
        ([(0, 0), (0, -1.2), (0, -2.4)], "side by side"),
        ([(0, 0), (-1.0, 0), (-2.0, 0)], "1.00 m apart"),
        ([(0, 0), (0, 0)], "at one place"),
        ([(-1.2, 0), (-2.4, 0)], "one place too far behind"),
        ([(0, 0), (-1.2, 0), (-9.0, 0)], ""),
        ([(0, 0)], ""),
    ],
)
def test_how_robots_stand_instead_of_in_a_row(places, words):
    names = [f"robot{number}" for number in range(1, len(places) + 1)]
    values = {
        f"truth/{name}/{axis}": place["xy".index(axis)]
        for name, place in zip(names, places, strict=True)
        for axis in "xy"
    }
    recording = SimpleNamespace(signal=lambda name: Signal(np.zeros(1), np.array([float(values[name])])))
    said = CHECKS.convoy_rows.misplaced(recording, names)
    assert words in said and bool(words) == bool(said)


@pytest.mark.parametrize(
    ("topic", "words"),
    [
        ("/robot2/front/odom", "was not remapped"),
        ("/robot2/robot1/odom", "write /robot1/odom"),
        ("/robot2/follower/odom", "~ stands for namespace and name of a node, /robot2/follower; odom without ~"),
    ],
)
def test_a_name_below_the_namespace_of_a_follower(topic, words):
    assert words in TOPICS._below_its_namespace(topic, "robot2", ["/robot1/odom", "/robot2/odom"])
    assert "write" not in TOPICS._below_its_namespace("/robot2/robot5/odom", "robot2", ["/robot1/odom"])


@pytest.mark.parametrize(
    ("node", "topic", "words"),
    [
        ("/robot1/bridge", "/cmd_vel", "not put before a name that begins with /, so /cmd_vel is one topic"),
        ("/bridge", "/cmd_vel", "without a namespace, the topics of all robots are one"),
        ("/robot1/bridge", "/robot1/bridge/cmd_vel", "cmd_vel without ~ becomes /robot1/cmd_vel"),
    ],
)
def test_names_of_bridges_in_namespaces(node, topic, words):
    assert words in said_of_a_bridge(node, topic, "/model/robot1/cmd_vel")


@pytest.mark.parametrize(
    ("gz_topic", "words"),
    [
        ("/model/robot2/cmd_vel", "two different robots"),
        ("/model/robot1/drive", "it is called /model/robot1/cmd_vel"),
        ("cmd_vel", "ROS namespaces do not count in Gazebo: bridge /model/robot1/cmd_vel"),
    ],
)
def test_another_topic_of_gazebo(gz_topic, words):
    assert words in said_of_a_bridge("/robot1/bridge", "/robot1/cmd_vel", gz_topic)


def said_of_a_bridge(node, topic, gz_topic):
    """Return the explanation of the topics of a single bridge."""
    bridge = {
        "source": node, "ros_topic": topic, "ros_type": "geometry_msgs/msg/Twist", "to_ros": 0, "to_gz": 9,
        "gz_topic": gz_topic, "gz_type": "gz.msgs.Twist", "direction": "ROS_TO_GZ",
        "publisher_qos": None, "subscription_qos": None,
    }  # fmt: skip
    facts = {"bridges": [bridge], "launch": {"bridges_started": [{"node": node}]}}
    recording = SimpleNamespace(facts=lambda: facts, properties=lambda entity: {}, signals=list)
    return TOPICS.own_topics(recording, {}).explanation


def seen_elsewhere(angle):
    """Return what is said of a follower that never drives ahead, and turns to one side after another."""
    run = Run(lambda h: (0.0, float(np.clip(2.0 * wrapped(angle(h)), -1.5, 1.5))))
    return FITS.seen_elsewhere(FITS.heard(run, "robot2", "robot1"))


def test_a_follower_that_looks_elsewhere_and_does_not_drive():
    assert seen_elsewhere(lambda h: bearing(h) - h.heading) == ""
    exchanged = seen_elsewhere(lambda h: np.arctan2(-h.aside, h.x + GAP - h.front_x) - h.front_heading)
    assert "takes its own odometry for that of the robot in front" in exchanged
    behind = seen_elsewhere(lambda h: np.arctan2(h.aside, h.front_x - GAP - h.x) - h.heading)
    assert "1.2 m too far behind" in behind
    assert "does not see that one move" in seen_elsewhere(lambda h: 0.0)


def test_a_speed_that_is_a_sum():
    total = [0.0]

    def summed(h):
        total[0] += 0.1 * (distance(h) - GAP)
        return float(np.clip(total[0], -5.0, 5.0))

    assert "its speed is a sum" in told(rule(summed), "speed")


def test_commands_that_come_too_seldom():
    signal = Signal(np.arange(0, 7_000_000_000, 1_000_000_000), np.zeros(7))
    assert "every 1.0 s only" in CHECKS.follower_ends.too_seldom(SimpleNamespace(signal=lambda name: signal), "robot2")
    often = Signal(np.arange(0, 7_000_000_000, 100_000_000), np.zeros(70))
    assert CHECKS.follower_ends.too_seldom(SimpleNamespace(signal=lambda name: often), "robot2") == ""


def follower(node="/robot2/follower", front="/robot1/odom"):
    ends = [
        {"kind": "subscription", "topic": "/robot2/odom", "node": node},
        {"kind": "subscription", "topic": front, "node": node},
        {"kind": "subscription", "topic": "/clock", "node": node},
        {"kind": "publisher", "topic": "/robot2/cmd_vel", "node": node},
    ]
    facts = {"endpoints": ends, "launch": {}}
    recording = SimpleNamespace(
        facts=lambda: facts, properties=lambda entity: {}, lines=lambda entity: [], signals=list
    )
    return TOPICS.listens_to_the_one_in_front(recording, {})


def test_names_of_followers_and_of_what_they_hear():
    assert follower().passed
    assert "a remapping of front/odom does not change it" in follower(front="/front/odom").explanation
    assert "that of another robot" in follower(front="/robot5/odom").explanation
    assert "is to be follower, in the namespace /robot2" in follower("/robot2/follower2").explanation


def test_a_follower_that_seldom_drives():
    turns = [0]

    def seldom(h):
        turns[0] += 1
        return speed_of(distance(h) - GAP) if turns[0] % 2 else 0.0

    assert "of its speeds are zero although it is behind" in told(rule(seldom), "speed")


def test_a_robot_that_begins_turned_is_not_in_its_row():
    def recorded(yaw):
        signals = {f"truth/robot1/{key}": [value] for key, value in (("x", 0.0), ("y", 0.0), ("yaw", yaw))}
        return SimpleNamespace(
            signals=lambda: signals,
            signal=lambda name: Signal(np.zeros(1, dtype=np.int64), np.array(signals[name])),
            properties=lambda entity: {"trial_parameters": '{"parameters": {"robots": "1"}}'},
            facts=lambda: {},
        )

    assert CHECKS.in_a_row(recorded(0.0), {}).passed
    assert "-Y of create turn a robot" in CHECKS.in_a_row(recorded(3.14), {}).explanation


def test_a_field_that_the_robot_does_not_obey():
    run = Run(rule(lambda h: 0.0))
    assert FITS.follower_origins.sideways(run, "robot2") == ""
    run.signals["topics/robot2/cmd_vel/linear/y"] = (np.arange(3.0), np.full(3, 0.4))
    assert "it sends linear.y and no linear.x" in FITS.follower_origins.sideways(run, "robot2")
    run.signals["topics/robot2/cmd_vel/linear/x"] = (np.arange(3.0), np.full(3, 0.4))
    assert FITS.follower_origins.sideways(run, "robot2") == ""


def test_from_where_on_a_follower_drives():
    near = told(rule(lambda h: speed_of(distance(h) - GAP) if distance(h) > 2.0 else 0.0), "speed")
    assert "it drives only from a distance of about 2.0 m on" in near
    facing = told(
        rule(lambda h: speed_of(distance(h) - GAP) if abs(wrapped(bearing(h) - h.heading)) < 0.05 else 0.0), "speed"
    )
    assert "rad to the side, and falls behind" in facing


@pytest.mark.parametrize(
    ("end", "words"),
    [
        (("subscription", "/robot1/odom", "geometry_msgs/msg/PoseStamped", "RELIABLE", "VOLATILE"), "equal types only"),
        (("publisher", "/robot2/cmd_vel", "geometry_msgs/msg/TwistStamped", "RELIABLE", "VOLATILE"), "publisher on"),
        (("publisher", "/robot2/cmd_vel", "geometry_msgs/msg/Twist", "BEST_EFFORT", "VOLATILE"), "BEST_EFFORT"),
        (("subscription", "/robot2/odom", "nav_msgs/msg/Odometry", "RELIABLE", "TRANSIENT_LOCAL"), "does not offer"),
        (("subscription", "/robot2/odom", "nav_msgs/msg/Odometry", "BEST_EFFORT", "VOLATILE"), ""),
        (("subscription", "/clock", "rosgraph_msgs/msg/Clock", "BEST_EFFORT", "VOLATILE"), ""),
    ],
)
def test_types_and_qualities_that_do_not_meet(end, words):
    kind, topic, type_, reliability, durability = end
    facts = {"node": "/robot2/follower", "kind": kind, "topic": topic, "type": type_}
    said = CHECKS.follower_ends.unheard(
        [facts | {"reliability": reliability, "durability": durability}], "robot2", "robot1"
    )
    assert words in said and bool(words) == bool(said)


def test_a_follower_that_soon_falls_silent():
    def published(count):
        signal = Signal(np.arange(0, count * 100_000_000, 100_000_000), np.zeros(count))
        return CHECKS.follower_ends.few(SimpleNamespace(signal=lambda name: signal), "robot2")

    assert "publishes 1 command only" in published(1) and published(0) == published(40) == ""


def test_only_the_last_robot_has_no_follower():
    topics = {"/robot1/odom": "subscription", "/robot2/odom": "subscription", "/clock": "subscription"}
    topics["/robot2/cmd_vel"] = "publisher"
    ends = [{"kind": kind, "topic": topic, "node": "/robot2/follower"} for topic, kind in topics.items()]
    facts = {"endpoints": ends, "launch": {}}
    given = {"trial_parameters": '{"parameters": {"robots": "3"}}'}
    recording = SimpleNamespace(
        facts=lambda: facts, properties=lambda entity: given, lines=lambda entity: [], signals=list
    )
    assert "only the last robot, robot3" in TOPICS.listens_to_the_one_in_front(recording, {}).explanation


def test_what_a_follower_does_while_it_falls_behind():
    slow = FITS.heard(Run(rule(lambda h: 0.2 + 0.01 * np.sin(h.x))), "robot2", "robot1")
    assert "its speed is about 0.2" in FITS.follower_origins.behind(slow)
    beside = FITS.heard(Run(lambda h: (0.3, 0.9)), "robot2", "robot1")
    assert "rad beside its own direction" in FITS.follower_origins.behind(beside)
    assert FITS.follower_origins.behind(FITS.heard(Run(rule()), "robot2", "robot1")) == ""
