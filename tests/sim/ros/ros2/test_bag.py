"""`ros2 bag` on the command line."""

import contextlib
import signal

import pytest
import yaml

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.tests.sim.ros.rosbag2.bags import TWIST, string, write_bag, write_database

ROS2 = "gz_course.sim.ros.ros2.command_line"


@pytest.fixture
def bag(call, tmp_path):
    return lambda *words: call(ROS2, "bag", *map(str, words))


def test_info_reindex_and_convert(bag, tmp_path, monkeypatch):
    monkeypatch.setenv("TZ", "UTC")
    folder = write_bag(tmp_path / "a", count=3)
    code, said = bag("info", folder)
    assert code == 0
    assert "Files:             a_0.mcap\n" in said
    assert "Duration:          0.020000000s\n" in said
    topic = "Topic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 2 | Serialization Format: cdr\n"
    assert f"{topic}{' ' * 19}Topic: /cmd_vel | Type: geometry_msgs/msg/Twist | Count: 1" in said
    assert bag("info", "-t", folder) == (0, "/chatter\n/cmd_vel\n")
    (folder / "metadata.yaml").unlink()
    assert bag("reindex", folder) == (0, "Reindexing complete: 3 messages in 1 file(s).\n")
    write_database(tmp_path / "old.db3", with_definitions=False)
    options = tmp_path / "out.yaml"
    options.write_text(f"output_bags:\n- uri: {tmp_path}/both\n  exclude_regex: cmd\n  compression_mode: message\n")
    code, said = bag("convert", "-i", folder, "-i", tmp_path / "old.db3", "sqlite3", "-o", options)
    assert (code, said) == (0, f"{tmp_path}/both: 12 messages of 1 topics\n")
    both = Bag(tmp_path / "both")
    assert sorted(m.data for m in both.messages())[0] == string("message 0")
    assert both.definitions()["std_msgs/msg/String"][0] == "ros2msg"
    options.write_text("output_bags:\n- uri: x\n  regexp: y\n")
    code, said = bag("convert", "-i", folder, "-o", options)
    assert (code, "unknown key 'regexp' of an output bag; did you mean 'regex'?" in said) == (1, True)


def test_bags_of_the_folder_are_offered(offered, tmp_path, monkeypatch):
    write_bag(tmp_path / "driving", count=1)
    (tmp_path / "one.mcap").touch()
    monkeypatch.chdir(tmp_path)
    assert offered("bag", "play", "") == ["driving", "one.mcap"]
    assert offered("bag", "") == ["burst", "convert", "info", "list", "play", "record", "reindex"]
    assert offered("bag", "record", "--storage-preset-profile", "zstd_") == ["zstd_fast", "zstd_small"]


def test_what_cannot_be_done_is_said_in_a_sentence(bag, tmp_path):
    for words, code, sentence in [
        (("play", tmp_path / "none"), 1, "does not exist!"),
        (("info", tmp_path), 1, "is not a bag"),
        (("record",), 2, "Need to specify at least one option"),
        (("record", "-a", "-s", "sqlite3", "--storage-preset-profile", "zstd_fast"), 1, "it has none, resilient"),
        (("record", "-a", "--compression-format", "zstd"), 2, "compression format without a compression mode"),
        (("record", "-e", "["), 1, "'[' is not a regular expression"),
        (("record", "-a", "-o", tmp_path), 1, "already exists."),
        (("record", "-a", "-b", "5"), 2, "at least 1024 bytes"),
        (("record", "-a", "--snapshot-mode", "--max-cache-size", "0"), 2, "shall not be set to zero"),
        (("record", "-a", "--qos-profile-overrides-path", tmp_path / "none"), 1, "cannot be read"),
        (("play", tmp_path, "-m", "a=b"), 2, "OLD:=NEW"),
        (("play", tmp_path, "-r", "0"), 2, "invalid rate value"),
    ]:
        try:
            seen, said = bag(*words)
        except SystemExit as end:
            seen, said = end.code, sentence
        assert (seen, sentence in said) == (code, True), (words, said)


@pytest.mark.parametrize("number", [signal.SIGTERM, pytest.param(signal.SIGKILL, marks=pytest.mark.proof)])
def test_an_ended_recorder_leaves_a_bag_that_is_played(programs, ros_node, spin_until, bag, tmp_path, number):
    from geometry_msgs.msg import Twist

    publisher = ros_node.create_publisher(Twist, "/cmd_vel", 10)
    recorder = programs.ros2("bag", "record", "/cmd_vel", "-o", tmp_path / "ended")

    def written():
        publisher.publish(Twist())
        with contextlib.suppress(BagError):  # its file may not have begun yet
            return next(Bag(tmp_path / "ended").messages(), None) is not None
        return False

    spin_until(written, "a message on the disk")
    recorder.process.send_signal(number)
    code = recorder.wait()
    ended = Bag(tmp_path / "ended")
    assert ended.topics["/cmd_vel"].type == TWIST.type
    if number == signal.SIGKILL:
        assert len(ended.complaints) == 2
        assert bag("reindex", ended.path)[0] == 0
        ended = Bag(ended.path)
    assert code == (0 if number == signal.SIGTERM else -9)
    assert all(recorder.said.count(word) == (number == signal.SIGTERM) for word in ["Recording stopped"])
    assert yaml.safe_load((ended.path / "metadata.yaml").read_text())["rosbag2_bagfile_information"]["version"] == 9
    if number == signal.SIGKILL:
        heard = []
        ros_node.create_subscription(Twist, "/cmd_vel", heard.append, 10)
        player = programs.ros2("bag", "play", ended.path)
        spin_until(lambda: len(heard) >= ended.metadata.count and player.process.poll() is not None, "all messages")
        assert player.wait() == 0


@pytest.mark.proof
def test_a_limit_of_the_file_size_is_a_full_disk(programs, ros_node, spin_until, tmp_path):
    from std_msgs.msg import String

    publisher = ros_node.create_publisher(String, "/text", 10)
    line = f"ulimit -f 3000; exec ros2 bag record /text -o {tmp_path}/full"
    recorder = programs.start("bash", "-c", line)

    def ended():
        publisher.publish(String(data="x" * 50_000))
        return recorder.process.poll() is not None

    spin_until(ended, "a full disk")
    assert recorder.wait() == 1
    assert "Recording has stopped; what was written before can be read." in recorder.said
    assert next(Bag(tmp_path / "full").messages()).topic == "/text"
