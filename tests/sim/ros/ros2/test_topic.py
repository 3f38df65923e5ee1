"""`ros2 topic` against real publishers and subscriptions."""

import os
import re
import signal
import sys

import pytest
import yaml

from gz_course.tests.sim.spinning import spinning

DEADLINE = 120.0
SYSTEM = ["/parameter_events", "/rosout"]


@pytest.fixture(scope="module")
def nodes(ros_domain):
    """Return two nodes: /talker publishes numbered texts, a scan and a latched map name; /listener subscribes."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from sensor_msgs.msg import LaserScan
    from std_msgs.msg import Int32, String

    # Two contexts, because one participant cannot have two types on a topic.
    context, other = rclpy.Context(), rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    rclpy.init(context=other, domain_id=ros_domain)
    talker = rclpy.create_node("talker", context=context)
    listener = rclpy.create_node("listener", namespace="/robot", context=other)
    chatter = talker.create_publisher(String, "chatter", 10)
    count = talker.create_publisher(Int32, "count", 10)
    scan = talker.create_publisher(LaserScan, "scan", rclpy.qos.qos_profile_sensor_data)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    talker.create_publisher(String, "map_name", latched).publish(String(data="maze"))
    talker.create_publisher(String, "two_kinds", 10)
    listener.create_publisher(Int32, "/two_kinds", 10)
    listener.create_subscription(String, "/chatter", lambda message: None, 10)
    listener.create_subscription(String, "_hidden", lambda message: None, 10)
    number = 0

    def publish():
        nonlocal number
        number += 1
        chatter.publish(String(data=f"hello {number}"))
        count.publish(Int32(data=number))
        scan.publish(LaserScan(ranges=[1.5] * 200))

    talker.create_timer(0.05, publish)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(talker)
    with spinning(executor):
        yield
    talker.destroy_node()
    listener.destroy_node()
    context.try_shutdown()
    other.try_shutdown()


LISTINGS = {
    "list": ["list"],
    "types": ["list", "--show-types"],
    "verbose": ["list", "-v", "--include-hidden-topics"],
    "count": ["list", "-c"],
    "info": ["info", "/chatter"],
    "info -v": ["info", "/chatter", "--verbose"],
    "info two": ["info", "/two_kinds"],
    "info unknown": ["info", "/chattr"],
    "type": ["type", "/scan"],
    "two types": ["type", "/two_kinds"],
    "type unknown": ["type", "/chattr"],
    "echo unknown": ["echo", "/chattr"],
}


@pytest.fixture(scope="module")
def listings(nodes, run_together):
    """Return the results of the verbs that wait for the whole graph or for a missing topic, run in parallel."""
    return dict(zip(LISTINGS, run_together(*(["topic", *words] for words in LISTINGS.values())), strict=True))


def test_list_names_every_topic_but_hidden_ones(listings):
    topics = ["/chatter", "/count", "/map_name", *SYSTEM, "/scan", "/two_kinds"]
    assert listings["list"] == (0, "".join(f"{topic}\n" for topic in topics), "")
    assert listings["count"] == (0, f"{len(topics)}\n", "")
    lines = listings["types"][1].splitlines()
    assert "/scan [sensor_msgs/msg/LaserScan]" in lines
    assert "/two_kinds [std_msgs/msg/Int32, std_msgs/msg/String]" in lines


def test_list_verbose_tells_who_is_there(listings):
    code, text, errors = listings["verbose"]
    assert (code, errors) == (0, "")
    published, subscribed, rest = text.split("\n\n")
    assert rest == ""
    assert published.startswith("Published topics:\n * /chatter [std_msgs/msg/String] 1 publisher\n")
    assert " * /two_kinds [std_msgs/msg/Int32, std_msgs/msg/String] 2 publishers" in published
    assert subscribed == (
        "Subscribed topics:\n * /chatter [std_msgs/msg/String] 1 subscriber\n"
        " * /robot/_hidden [std_msgs/msg/String] 1 subscriber"
    )


def test_list_by_itself_waits_for_everybody(ros2, nodes, listings):
    assert ros2("topic", "list") == listings["list"]


def test_info(listings):
    counts = "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 1\n"
    assert listings["info"] == (0, counts, "")
    both = "Type: ['std_msgs/msg/Int32', 'std_msgs/msg/String']\nPublisher count: 2\nSubscription count: 0\n"
    assert listings["info two"] == (0, both, "")
    code, text, _ = listings["info -v"]
    parts = text.split("\n\n")
    assert code == 0
    assert parts[:2] == ["Type: std_msgs/msg/String", "Publisher count: 1"]
    assert parts[2].startswith("Node name: talker\nNode namespace: /\nTopic type: std_msgs/msg/String\n")
    assert "Reliability: RELIABLE" in parts[2]
    assert parts[3] == "Subscription count: 1"
    assert parts[4].startswith("Node name: listener\nNode namespace: /robot\n")


def test_an_unknown_topic_is_an_error_that_names_the_nearest(listings):
    assert listings["info unknown"] == (1, "", "Unknown topic '/chattr'; did you mean '/chatter'?\n")
    assert listings["type unknown"] == (1, "", "Unknown topic '/chattr'; did you mean '/chatter'?\n")
    assert listings["echo unknown"] == (
        1,
        "WARNING: topic [/chattr] does not appear to be published yet\n",
        "Could not determine the type for the passed topic; did you mean '/chatter'?\n",
    )


ECHOES = {
    "two kinds": ["echo", "/two_kinds", "--once"],
    "relative": ["echo", "chatter", "--once"],
    "latched": ["echo", "/map_name", "--once"],
    "best effort": ["echo", "/scan", "sensor_msgs/msg/LaserScan", "--once"],
    "short": ["echo", "/scan", "sensor_msgs/msg/LaserScan", "--once", "-l", "2", "--flow-style"],
    "field": ["echo", "/scan", "sensor_msgs/msg/LaserScan", "--once", "--field", "header.stamp.sec"],
    "message field": ["echo", "/scan", "sensor_msgs/msg/LaserScan", "--once", "--field", "header"],
    "csv": ["echo", "/count", "std_msgs/msg/Int32", "--once", "--csv"],
    "info": ["echo", "/count", "std_msgs/msg/Int32", "--once", "-i"],
    "raw": ["echo", "/count", "std_msgs/msg/Int32", "--once", "--raw"],
    "filter": ["echo", "/count", "std_msgs/msg/Int32", "--once", "--filter", "m.data % 7 == 0"],
    "timeout": ["echo", "/count", "std_msgs/msg/Int32", "--filter", "False", "--timeout", "0.2"],
    "given type": ["echo", "/count", "std_msgs/Int32", "--once"],
    "wrong field": ["echo", "/scan", "sensor_msgs/msg/LaserScan", "--field", "header.stmp"],
    "wrong type": ["echo", "/count", "std_msgs/msg/Strng"],
    "wrong filter": ["echo", "/count", "std_msgs/msg/Int32", "--filter", "m.data >"],
    "failing filter": ["echo", "/count", "std_msgs/msg/Int32", "--filter", "m.dat > 1"],
    "bad name": ["echo", "/a b"],
    "other type": ["echo", "/scan", "sensor_msgs/msg/Image", "--timeout", "0.2"],
}


@pytest.fixture(scope="module")
def echoes(nodes, run_together):
    return dict(zip(ECHOES, run_together(*(["topic", *words] for words in ECHOES.values())), strict=True))


def test_type(listings):
    assert listings["type"] == (0, "sensor_msgs/msg/LaserScan\n", "")
    assert listings["two types"] == (0, "std_msgs/msg/Int32\nstd_msgs/msg/String\n", "")


@pytest.mark.parametrize(
    ("echo", "pattern"),
    [
        ("relative", r"data: hello \d+\n---\n"),
        ("latched", r"data: maze\n---\n"),
        ("best effort", r"header:\n  stamp:\n(?s:.)*\nranges:\n(- 1\.5\n){128}- '\.\.\.'\nintensities: \[\]\n---\n"),
        ("short", r"header:\n  stamp: {sec: 0, nanosec: 0}\n(?s:.)*\nranges: \[1\.5, 1\.5, '\.\.\.'\]\n(?s:.)*---\n"),
        ("field", r"0\n---\n"),
        ("message field", r"stamp:\n  sec: 0\n  nanosec: 0\nframe_id: ''\n---\n"),
        ("csv", r"\d+\n"),
        ("raw", r"b(['\"])\\x00\\x01\\x00\\x00.*\1\n---\n"),
        ("given type", r"data: \d+\n---\n"),
        ("timeout", ""),
    ],
    ids=lambda value: value if value in ECHOES else "",
)
def test_echo_prints_a_message(echoes, echo, pattern):
    code, text, errors = echoes[echo]
    assert (code, errors) == (0, "")
    assert re.fullmatch(pattern, text), text


def test_echo_of_another_type_is_told_that_nothing_can_arrive(echoes):
    sentence = (
        "The topic /scan has the type sensor_msgs/msg/LaserScan, not sensor_msgs/msg/Image: no message can arrive\n"
    )
    assert echoes["other type"] == (0, "", sentence)


def test_echo_with_info_prints_two_documents(echoes):
    info, message, _ = yaml.safe_load_all(echoes["info"][1])
    assert info["source_timestamp"] <= info["received_timestamp"]
    assert message["data"] > 0


def test_echo_filters(echoes):
    assert yaml.safe_load(echoes["filter"][1].removesuffix("---\n"))["data"] % 7 == 0


@pytest.mark.parametrize(
    ("echo", "sentence"),
    [
        (
            "two kinds",
            "Cannot echo topic '/two_kinds', as it contains more than one type: "
            "[std_msgs/msg/Int32, std_msgs/msg/String]",
        ),
        (
            "wrong field",
            "Invalid field 'header.stmp': Header has no field 'stmp', it has the fields stamp, frame_id; "
            "did you mean 'stamp'?",
        ),
        (
            "wrong type",
            "The message type 'std_msgs/msg/Strng' is invalid; did you mean 'std_msgs/msg/String'?",
        ),
        ("wrong filter", "--filter 'm.data >' is not a Python expression: invalid syntax"),
        ("failing filter", "--filter 'm.dat > 1' failed on a message: 'Int32' object has no attribute 'dat'"),
        ("bad name", "'/a b' is not a topic name: "),
    ],
    ids=lambda value: value if value in ECHOES else "",
)
def test_echo_says_what_is_wrong_in_one_sentence(echoes, echo, sentence):
    code, text, errors = echoes[echo]
    assert (code, text) == (1, "")
    assert errors.startswith(sentence)
    assert len(errors.splitlines()) == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_echo_without_traceback(start, nodes, number):
    command = start("topic", "echo", "/count")
    command.wait_for("---")
    os.kill(command.process.pid, number)
    code, _, errors = command.wait()
    assert (code, errors) == (2, "")


def test_echo_into_a_closed_pipe_ends_quietly(start, nodes):
    command = start(
        command=(
            "bash",
            "-c",
            '"$0" -m gz_course.sim.ros.ros2 topic echo /count | head -n 2; echo "${PIPESTATUS[0]}"',
            sys.executable,
        )
    )
    code, text, errors = command.wait()
    assert (code, errors) == (0, "")
    assert text.splitlines()[1:] == ["---", "0"]


def test_hz_reports_every_second(start, nodes):
    command = start("topic", "hz", "/scan", "--window", "5")
    command.wait_for("window: 5")
    os.kill(command.process.pid, signal.SIGINT)
    code, text, errors = command.wait()
    assert (code, errors) == (2, "")
    number = r"\d+\.\d{3}"
    report = rf"average rate: {number}\n\tmin: {number}s max: {number}s std dev: \d+\.\d{{5}}s window: [1-5]\n"
    assert re.fullmatch(f"({report})+", text), text


def test_hz_of_a_missing_topic_waits_and_names_the_nearest(start, nodes):
    command = start("topic", "hz", "/scn", "--spin-time", "2")
    command.wait_for("WARNING: topic [/scn] does not appear to be published yet")
    os.kill(command.process.pid, signal.SIGINT)
    assert command.wait()[0] == 2


def test_without_a_home_it_works_all_the_same(ros2, nodes):
    environment = {"HOME": "/nonexistent", "ROS_LOG_DIR": "", "ROS_HOME": ""}
    assert ros2("topic", "type", "/scan", environment=environment)[0] == 0
