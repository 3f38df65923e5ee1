"""`rosbag2_py` writes and reads bags as the programs of ROS's tutorials do."""

import pytest

from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.tests.sim.ros.rosbag2.bags import START, STEP, write_bag


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_what_is_written_is_read(tmp_path, storage):
    import rosbag2_py
    from rclpy.serialization import deserialize_message, serialize_message
    from std_msgs.msg import String

    folder = str(tmp_path / "b")
    writer = rosbag2_py.SequentialWriter()
    writer.open(rosbag2_py.StorageOptions(uri=folder, storage_id=storage), rosbag2_py.ConverterOptions("", ""))
    topic = rosbag2_py.TopicMetadata(name="/chatter", type="std_msgs/msg/String", serialization_format="cdr")
    writer.create_topic(topic)
    for number in range(5):
        writer.write("/chatter", serialize_message(String(data=f"hello {number}")), START + number)
    with pytest.raises(RuntimeError, match="Call 'create_topic' first"):
        writer.write("/other", b"", START)
    del writer  # finishes the bag
    assert Bag(tmp_path / "b").complaints == []
    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(uri=folder, storage_id=storage), rosbag2_py.ConverterOptions("cdr", "cdr"))
    assert [(each.name, each.type) for each in reader.get_all_topics_and_types()] == [("/chatter", topic.type)]
    read = []
    while reader.has_next():
        name, data, time = reader.read_next()
        read.append((name, deserialize_message(data, String).data, time - START))
    assert read == [("/chatter", f"hello {number}", number) for number in range(5)]
    with pytest.raises(RuntimeError, match="No next message"):
        reader.read_next()
    reader.seek(START + 3)
    assert deserialize_message(reader.read_next()[1], String).data == "hello 3"
    about = reader.get_metadata()
    assert (about.message_count, about.duration.nanoseconds, about.starting_time.nanoseconds) == (5, 4, START)
    assert rosbag2_py.Info().read_metadata(folder, storage).topics_with_message_count[0].message_count == 5
    assert reader.get_all_message_definitions()[0].encoding == "ros2msg"


def test_filters_orders_and_errors(tmp_path):
    import rosbag2_py

    reader = rosbag2_py.SequentialReader()
    with pytest.raises(RuntimeError, match="not open"):
        reader.get_metadata()
    with pytest.raises(RuntimeError, match="does not exist"):
        reader.open_uri(str(tmp_path / "none"))
    reader.open_uri(str(write_bag(tmp_path / "f", count=10)))
    reader.set_filter(rosbag2_py.StorageFilter(topics=["/cmd_vel"]))
    assert reader.read_next()[0::2] == ("/cmd_vel", START + STEP)
    reader.reset_filter()
    assert reader.set_read_order(rosbag2_py.ReadOrder(reverse=True))
    assert reader.read_next()[2] == START + 9 * STEP
    reader.seek(START + 4 * STEP)
    assert [reader.read_next()[2] for _ in range(2)] == [START + 4 * STEP, START + 3 * STEP]
    assert not reader.set_read_order(rosbag2_py.ReadOrder(rosbag2_py.ReadOrderSortBy.File))
    with pytest.raises(AttributeError, match="ros2 bag record"):
        rosbag2_py.Recorder()
    with pytest.raises(RuntimeError, match="there is no 'nope'"):
        rosbag2_py.SequentialWriter().open(rosbag2_py.StorageOptions(str(tmp_path / "x"), "nope"))
