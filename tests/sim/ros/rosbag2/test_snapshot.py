"""Recording into memory: only what is kept is written, and only when a snapshot is asked for."""

from gz_course.sim.ros.rosbag2.recording.recorder import Recorder, RecordOptions
from gz_course.sim.ros.rosbag2.recording.snapshot import SnapshotThread
from gz_course.sim.ros.rosbag2.selection import Selection
from gz_course.sim.ros.rosbag2.services import offer_recorder
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.stored_types import installed_class
from gz_course.tests.sim.ros.rosbag2.bags import CHATTER, START


def test_the_last_messages_are_written_once(tmp_path):
    writing = SnapshotThread(BagWriter(tmp_path / "s"), 1000)
    writing.add_topic(CHATTER, ("ros2msg", "string data\n"))
    for number in range(50):
        writing.write("/chatter", START + number, 0, b"x" * 99)
    assert writing.snapshot()
    assert writing.snapshot()
    writing.write("/chatter", START + 100, 0, b"y")
    writing.close()
    bag = Bag(tmp_path / "s")
    assert [m.received - START for m in bag.messages()] == list(range(40, 50))
    assert not writing.lost


def test_the_services_of_a_recorder(nodes, tmp_path):
    from rosbag2_interfaces.msg import WriteSplitEvent
    from rosbag2_interfaces.srv import IsPaused, Pause, Snapshot, SplitBagfile
    from std_msgs.msg import String

    writing = SnapshotThread(BagWriter(tmp_path / "live"), 1 << 20)
    recorder = Recorder(nodes.own, writing, RecordOptions(Selection(topics=("/kept",))), installed_class)
    offer_recorder(nodes.own, recorder)
    splits = []
    told = nodes.other.create_subscription(WriteSplitEvent, "/events/write_split", splits.append, 10)
    talker = nodes.other.create_publisher(String, "/kept", 10)
    nodes.until(lambda: recorder.topics() and told.get_publisher_count(), recorder.look)
    nodes.until(talker.get_subscription_count)
    nodes.until(lambda: writing._kept, lambda: talker.publish(String(data="hello")))

    def ask(kind, name):
        client = nodes.other.create_client(kind, f"/rosbag2/{name}")
        nodes.until(client.service_is_ready)
        future = client.call_async(kind.Request())
        nodes.until(future.done)
        nodes.other.destroy_client(client)
        return future.result()

    assert ask(Snapshot, "snapshot").success
    ask(SplitBagfile, "split_bagfile")
    nodes.until(lambda: splits)
    assert splits[0].closed_file.endswith("live_0.mcap") and splits[0].opened_file.endswith("live_1.mcap")
    ask(Pause, "pause")
    assert ask(IsPaused, "is_paused").paused
    recorder.take_the_rest()
    writing.close()
    assert next(Bag(tmp_path / "live").messages()).topic == "/kept"
    nodes.other.destroy_subscription(told)
    nodes.other.destroy_publisher(talker)
