"""Recorder and player over real DDS: what is published is recorded, what is recorded is played."""

import dataclasses
import threading
import time

import pytest

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.playing.player import Player, PlayOptions
from gz_course.sim.ros.rosbag2.qos import overrides, to_offer
from gz_course.sim.ros.rosbag2.recording.recorder import Recorder, RecordOptions
from gz_course.sim.ros.rosbag2.recording.writing_thread import WritingThread
from gz_course.sim.ros.rosbag2.selection import Selection
from gz_course.sim.ros.rosbag2.services import offer_player
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.storage.metadata import Topic
from gz_course.sim.ros.rosbag2.stored_types import StoredTypes, installed_class, installed_hash
from gz_course.tests.sim.ros.rosbag2.bags import CHATTER, SAID, START, STEP, TWIST, string, write_bag


def test_topics_are_recorded_with_the_qos_of_their_publishers(nodes, tmp_path):
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
    from std_msgs.msg import Int32, String
    from tf2_msgs.msg import TFMessage

    latched = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    lossy = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)
    ends = {
        "map": nodes.other.create_publisher(String, "/a/map", latched),
        "odd": nodes.other.create_publisher(Int32, "/a/odd", lossy),
        "tf": nodes.other.create_publisher(TFMessage, "/a/tf", 10),
        "hidden": nodes.other.create_publisher(Int32, "/a/_hidden", 10),
        "left": nodes.other.create_publisher(Int32, "/a/left_out", 10),
    }
    ends["map"].publish(String(data="sent before"))
    writing = WritingThread(BagWriter(tmp_path / "live"), 0)
    taken = {}
    keep = writing.write
    writing.write = lambda topic, *rest: (taken.setdefault(topic, []).append(rest), keep(topic, *rest))
    selection = Selection(regex="^/a/", without_regex="left")
    recorder = Recorder(nodes.own, writing, RecordOptions(selection), installed_class)
    wanted = ["/a/map", "/a/odd", "/a/tf"]
    nodes.until(lambda: recorder.topics() == wanted, recorder.look)
    nodes.until(lambda: all(ends[name].get_subscription_count() for name in ("map", "odd", "tf")))
    nodes.until(lambda: "/a/odd" in taken, lambda: ends["odd"].publish(Int32(data=7)))
    nodes.until(lambda: "/a/tf" in taken and "/a/map" in taken, lambda: ends["tf"].publish(TFMessage()))
    # A best-effort publisher comes to a reliable topic: it is heard, too.
    late = nodes.other.create_publisher(String, "/a/map", lossy)
    nodes.until(lambda: late.get_subscription_count(), recorder.look)
    nodes.until(lambda: any(b"late" in rest[2] for rest in taken["/a/map"]), lambda: late.publish(String(data="late")))
    recorder.pause()
    recorder.take_the_rest()
    assert recorder.topics() == []
    writing.close()
    assert writing.failure == ""
    bag = Bag(tmp_path / "live")
    assert bag.complaints == []
    assert {name: topic.type for name, topic in bag.topics.items()} == {
        **{"/a/map": "std_msgs/msg/String", "/a/odd": "std_msgs/msg/Int32", "/a/tf": "tf2_msgs/msg/TFMessage"}
    }
    assert bag.topics["/a/map"].qos[0].durability == "transient_local"
    assert bag.topics["/a/odd"].qos[0].reliability == "best_effort"
    assert all(topic.type_hash.startswith("RIHS01_") for topic in bag.topics.values())
    messages = list(bag.messages())
    assert next(m.data for m in messages if m.topic == "/a/map") == string("sent before")
    assert all(0 < m.sent <= m.received < time.time_ns() for m in messages)
    assert "MSG: geometry_msgs/Transform" in bag.definitions()["tf2_msgs/msg/TFMessage"][1]
    for end in (*ends.values(), late):
        nodes.other.destroy_publisher(end)


@pytest.fixture
def played(nodes):
    """Play a bag in a thread; yields a function that returns the player and what a subscriber hears."""
    running = []

    def start(bag, type_name="std_msgs/msg/String", topic="/chatter", types=installed_class, **options):
        heard = []
        player = Player(nodes.own, bag, PlayOptions(**options), types)
        end = nodes.other.create_subscription(types(type_name), topic, heard.append, 100)
        publishers = [*player._publishers.values(), *([player._clock_publisher] if player._clock_publisher else [])]
        nodes.until(lambda: all(each.get_subscription_count() for each in publishers) and end.get_publisher_count())
        thread = threading.Thread(target=player.play)
        running.append((player, thread, end))
        thread.start()
        return player, heard, thread

    yield start
    for player, thread, end in running:
        player.stop()
        thread.join()
        nodes.other.destroy_subscription(end)
        for publisher in player._publishers.values():
            nodes.own.destroy_publisher(publisher)


def test_a_paused_bag_is_stepped_sought_and_played_to_its_end(nodes, played, tmp_path):
    from rosbag2_interfaces.srv import GetRate, PlayNext, Seek, SetRate, TogglePaused

    bag = Bag(write_bag(tmp_path / "p", count=40, topics=(SAID,)))
    player, heard, thread = played(bag, paused=True)
    offer_player(nodes.own, player)

    def ask(kind, name, **values):
        client = nodes.other.create_client(kind, f"/rosbag2/{name}")
        nodes.until(client.service_is_ready)
        future = client.call_async(kind.Request(**values))
        nodes.until(future.done)
        nodes.other.destroy_client(client)
        return future.result()

    assert ask(PlayNext, "play_next").success
    nodes.until(lambda: [m.data for m in heard] == ["message 0"])
    assert player.play_next(2) == 2
    nodes.until(lambda: len(heard) == 3)
    request = Seek.Request()
    request.time.sec, request.time.nanosec = divmod(START + 38 * STEP, 10**9)
    assert ask(Seek, "seek", time=request.time).success
    assert not player.seek(START - 1)
    assert not ask(SetRate, "set_rate", rate=-1.0).success
    assert ask(SetRate, "set_rate", rate=1000.0).success
    assert ask(GetRate, "get_rate").rate == 1000.0
    ask(TogglePaused, "toggle_paused")
    nodes.until(lambda: not thread.is_alive())
    nodes.until(lambda: [m.data for m in heard][3:] == ["message 38", "message 39"])


def test_part_of_a_bag_is_played_under_another_name_with_its_time(nodes, played, tmp_path):
    from rosgraph_msgs.msg import Clock

    bag = Bag(write_bag(tmp_path / "q", count=10, topics=(SAID,)))
    clocks = []
    end = nodes.other.create_subscription(Clock, "/clock", clocks.append, 1000)
    _, heard, thread = played(
        bag,
        topic="/other_name",
        remapped={"/chatter": "/other_name"},
        start_offset=3 * STEP,
        until=START + 7 * STEP,
        clock_hz=500.0,
        rate=0.5,
    )
    nodes.until(lambda: not thread.is_alive() and len(heard) == 5)
    assert [m.data for m in heard] == [f"message {n}" for n in range(3, 8)]
    nodes.until(lambda: clocks)
    times = [each.clock.sec * 10**9 + each.clock.nanosec for each in clocks]
    assert START + 3 * STEP <= times[0] <= times[-1] <= START + 7 * STEP
    assert times == sorted(times), "time does not go back"
    nodes.other.destroy_subscription(end)


def test_types_that_are_not_installed_come_from_the_bag(nodes, played, tmp_path):
    text = "# seen nowhere else\nfloat64 distance 2.5\nKind kind\ngeometry_msgs/Point where\n"
    text += "=" * 80 + "\nMSG: only_in_this_bag/msg/Kind\nuint8 value\n"
    kind = "only_in_this_bag/msg/Reading"
    folder = tmp_path / "r"
    writer = BagWriter(folder)
    writer.add_topic(Topic("/reading", kind), ("ros2msg", text))
    writer.add_topic(Topic("/unknown", "not_in_any_bag/msg/X"), ("unknown", ""))
    data = b"\0\1\0\0" + bytes.fromhex("0000000000001440") + b"\x09" + bytes(7)
    data += bytes.fromhex("000000000000f03f") * 3
    writer.write("/reading", START, 0, data)
    writer.close()
    bag = Bag(folder)
    with StoredTypes(bag.definitions()) as types:
        with pytest.raises(BagError, match=r"not known here: .*, and the bag does not hold its definition"):
            types.message_class("not_in_any_bag/msg/X")
        with pytest.raises(BagError, match="is not the name of a message type"):
            types.message_class("../../etc/msg/X")
        _, heard, _ = played(bag, type_name=kind, topic="/reading", types=types.message_class)
        nodes.until(lambda: heard)
    assert (heard[0].distance, heard[0].kind.value, heard[0].where.z) == (5.0, 9, 1.0)


def test_another_definition_of_a_type_is_told(nodes, tmp_path, capfd):
    assert installed_hash(CHATTER.type) == CHATTER.type_hash
    assert installed_hash("no_such_package/msg/X") == ""
    other = dataclasses.replace(SAID, name="/other", type_hash="RIHS01_" + "0" * 64)
    bag = Bag(
        write_bag(tmp_path / "o", count=2, topics=(dataclasses.replace(SAID, type_hash=CHATTER.type_hash), other))
    )
    player = Player(nodes.own, bag, PlayOptions(), installed_class)
    said = capfd.readouterr().err
    assert said.count("another definition of std_msgs/msg/String") == 1
    assert "'/other' was recorded" in said
    for publisher in player._publishers.values():
        nodes.own.destroy_publisher(publisher)


def test_events_of_services_and_parts_of_actions_have_classes():
    from example_interfaces.action import Fibonacci
    from std_srvs.srv import SetBool

    assert installed_class("std_srvs/srv/SetBool_Event") is SetBool.Event
    assert installed_class("example_interfaces/action/Fibonacci_FeedbackMessage") is Fibonacci.Impl.FeedbackMessage


def test_qos_overrides_are_read(tmp_path):
    path = tmp_path / "qos.yaml"
    path.write_text("/chatter:\n  reliability: best_effort\n  depth: 7\n  deadline: {sec: 1, nsec: 500000000}\n")
    qos = overrides(path)["/chatter"]
    assert (qos.depth, qos.reliability.name, qos.deadline.nanoseconds) == (7, "BEST_EFFORT", 1_500_000_000)
    for text, sentence in [
        ("/x: {reliabilty: reliable}", "unexpected key 'reliabilty'.*did you mean 'reliability'"),
        ("/x: {reliability: realiable}", "cannot be 'realiable'"),
        ("/x: {depth: -1}", "cannot be -1"),
        ("/x: {deadline: {sec: 1}}", "needs both 'sec' and 'nsec'"),
        ("- a", "expected a mapping"),
    ]:
        path.write_text(text)
        with pytest.raises(BagError, match=sentence):
            overrides(path)
    assert to_offer(CHATTER.qos[0]).reliability.name == "BEST_EFFORT"
    assert to_offer(TWIST.qos[0]).depth == 10
