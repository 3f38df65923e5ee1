"""Bags are read as they were written; truncated, foreign and hostile ones are read as far as they go, or refused."""

import errno
import os
import random
import struct

import mcap.reader
import pytest
import yaml
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk, Schema

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.recording.writing_thread import WritingThread
from gz_course.sim.ros.rosbag2.storage import mcap_writing
from gz_course.sim.ros.rosbag2.storage.bag import Bag, reindex
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.storage.mcap_reading import MAGIC
from gz_course.sim.ros.rosbag2.storage.metadata import from_yaml
from gz_course.tests.sim.ros.rosbag2.bags import CHATTER, START, STEP, TWIST, string, twist, write_bag, write_database

FUZZED = 50_000


def texts(bag, **options):
    return [message.data for message in bag.messages(**options)]


WAYS = [("mcap", preset) for preset in mcap_writing.PRESETS] + [("sqlite3", "none")]


@pytest.mark.parametrize(("storage", "preset"), WAYS)
def test_a_bag_is_read_as_it_was_written(tmp_path, storage, preset):
    folder = write_bag(tmp_path / "a_bag", storage=storage, preset=preset, custom_data={"robot": "blue"})
    bag = Bag(folder)
    assert bag.complaints == []
    assert bag.topics == {"/chatter": CHATTER, "/cmd_vel": TWIST}
    assert texts(bag) == [string(f"message {n}") if n % 2 == 0 else twist(n) for n in range(100)]
    assert (bag.start, bag.end) == (START, START + 99 * STEP)
    assert bag.metadata.counts == {"/chatter": 50, "/cmd_vel": 50}
    assert texts(bag, topics={"/cmd_vel"}, begin=START + 90 * STEP) == [twist(n) for n in (91, 93, 95, 97, 99)]
    first = next(iter(bag.messages()))
    assert (first.received, first.sent) == (START, START - 5 if storage == "mcap" else START)
    stored = bag.metadata
    (folder / "metadata.yaml").unlink()
    rebuilt = reindex(folder)
    assert (rebuilt.counts, rebuilt.files, rebuilt.start, rebuilt.duration) == (
        *(stored.counts, stored.files, stored.start, stored.duration),
    )
    assert (rebuilt.custom_data, rebuilt.distro) == ({"robot": "blue"}, "jazzy")
    assert Bag(folder).metadata == rebuilt


def test_the_library_of_mcap_reads_it(tmp_path):
    folder = write_bag(tmp_path / "b")
    with (folder / "b_0.mcap").open("rb") as file:
        reader = mcap.reader.make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "ros2"
        found = [(schema.name, schema.encoding, channel.topic) for schema, channel, _ in reader.iter_messages()]
        assert found[0] == ("std_msgs/msg/String", "ros2msg", "/chatter")
        assert len(found) == 100
        told = {each.name: each.metadata for each in reader.iter_metadata()}
    assert yaml.safe_load(told["rosbag2"]["serialized_metadata"])["version"] == 9
    schemas = Bag(folder).definitions()
    assert "=" * 80 + "\nMSG: geometry_msgs/Vector3\n" in schemas["geometry_msgs/msg/Twist"][1]


def test_a_bag_is_split_by_size_and_by_time(tmp_path):
    bag = Bag(write_bag(tmp_path / "by_time", split_ns=25 * STEP))
    assert [file.count for file in bag.metadata.files] == [25, 25, 25, 25]
    assert bag.metadata.files[3].path == "by_time_3.mcap"
    assert len(texts(bag)) == 100
    bag = Bag(write_bag(tmp_path / "by_size", split_bytes=1024, keep=2))
    assert len(bag.metadata.files) == 2
    assert len(list((tmp_path / "by_size").glob("*.mcap"))) == 2
    assert texts(bag)[-1] == twist(99)


def test_a_file_that_ends_anywhere_is_read_up_to_there(tmp_path):
    folder = tmp_path / "killed"
    writer = BagWriter(folder)
    writer.add_topic(CHATTER, ("ros2msg", "string data\n"))
    for number in range(20):
        writer.write("/chatter", START + number, 0, string(f"message {number}"))
        writer.flush()  # a chunk for each
    path = folder / "killed_0.mcap"
    whole = path.read_bytes()
    bag = Bag(folder)
    assert len(texts(bag)) == 20
    assert any("ends before its end mark" in each for each in bag.complaints)
    assert any("ros2 bag reindex" in each for each in bag.complaints)
    writer.abandon()
    counts = set()
    for size in range(len(MAGIC), len(whole), 97):
        path.write_bytes(whole[:size])
        bag = Bag(folder)
        counts.add(len(texts(bag)))
        assert bag.metadata.count == len(texts(bag))
        assert reindex(folder).count == bag.metadata.count
        (folder / "metadata.yaml").unlink()
    assert counts == set(range(20))


def test_a_full_disk_leaves_what_was_written(tmp_path, monkeypatch):
    room = 20_000
    write = os.write

    def limited(file, data):
        nonlocal room
        if room <= 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        done = write(file, bytes(data)[:room])
        room -= done
        return done

    monkeypatch.setattr(mcap_writing.os, "write", limited)
    writing = WritingThread(BagWriter(tmp_path / "full", preset="fastwrite"), 0)
    writing.add_topic(CHATTER, ("ros2msg", "string data\n"))
    for number in range(400):
        writing.write("/chatter", START + number, 0, string("x" * 100))
    writing.close()
    assert "No space left on device" in writing.failure
    assert "what was written before can be read" in writing.failure
    bag = Bag(tmp_path / "full")
    assert 100 < len(texts(bag)) == bag.metadata.count < 200
    assert bag.complaints == [each for each in bag.complaints if "ends before its end mark" in each]


def test_messages_that_wait_too_long_are_lost_and_counted(tmp_path):
    writing = WritingThread(BagWriter(tmp_path / "slow"), 1000)
    with writing._changed:  # the writer cannot take any
        for number in range(50):
            writing.write("/chatter", START + number, 0, b"x" * 100) if number else writing.add_topic(
                CHATTER, ("ros2msg", "string data\n")
            )
    writing.close()
    assert writing.lost == {"/chatter": 39}
    assert len(texts(Bag(tmp_path / "slow"))) == 10


@pytest.mark.parametrize("with_definitions", [True, False])
def test_databases_are_read(tmp_path, with_definitions):
    bag = Bag(write_database(tmp_path / "a.db3", with_definitions))
    assert texts(bag) == [string(f"message {n}") for n in range(10)]
    assert bag.metadata.storage == "sqlite3"
    assert bag.metadata.counts == {"/chatter": 10}
    qos = bag.topics["/chatter"].qos[0]
    assert (qos.history, qos.depth, qos.reliability, qos.durability) == (
        "keep_last",
        7,
        "best_effort",
        "transient_local",
    )
    assert bag.definitions().keys() == ({"std_msgs/msg/String"} if with_definitions else set())


def test_what_is_no_bag_is_refused_with_a_sentence(tmp_path):
    def refused(path):
        with pytest.raises(BagError) as caught:
            list(Bag(path).messages())
        return str(caught.value)

    assert "does not exist" in refused(tmp_path / "nothing")
    (tmp_path / "empty").mkdir()
    assert "neither metadata.yaml nor .mcap or .db3 files" in refused(tmp_path / "empty")
    (tmp_path / "text.mcap").write_text("hello")
    assert "neither as MCAP nor as SQLite" in refused(tmp_path / "text.mcap")
    (tmp_path / "a.db3").write_bytes(b"SQLite format 3\0" + bytes(5000))
    assert "not a readable database" in refused(tmp_path / "a.db3")
    import sqlite3

    with sqlite3.connect(tmp_path / "endless.db3") as database:
        database.execute("CREATE TABLE topics(id, name, type, serialization_format)")
        database.execute(
            "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) "
            "SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM n"
        )
    database.close()
    assert "has no tables" in refused(tmp_path / "endless.db3")
    with pytest.raises(BagError, match="already exists"):
        BagWriter(tmp_path / "empty")


def test_a_chunk_that_claims_too_much_takes_no_memory(tmp_path):
    import zstandard

    for packed, size in ((zstandard.compress(bytes(1 << 20)), 1 << 62), (zstandard.compress(bytes(1 << 26)), 100)):
        built = RecordBuilder()
        Schema(1, b"", "", "x").write(built)
        Chunk("zstd", packed, 5, 1, 0, size).write(built)
        (tmp_path / "bomb.mcap").write_bytes(MAGIC + built.end())
        bag = Bag(tmp_path / "bomb.mcap")
        assert list(bag.messages()) == []
        assert "not whole" in bag.complaints[0]


def test_a_message_shorter_than_its_head_is_left_out(tmp_path):
    whole = write_bag(tmp_path / "s", count=1, preset="fastwrite") / "s_0.mcap"
    short = tmp_path / "short.mcap"
    short.write_bytes(MAGIC + struct.pack("<BQ", 5, 3) + b"abc" + whole.read_bytes()[len(MAGIC) :])
    bag = Bag(short)
    assert "a record cannot be read" in bag.complaints[0]
    assert len(texts(bag)) == 1


def test_metadata_of_older_versions_and_of_no_version():
    old = {
        "version": 4,
        "storage_identifier": "sqlite3",
        "relative_file_paths": ["old_0.db3"],
        "duration": {"nanoseconds": 5},
        "starting_time": {"nanoseconds_since_epoch": 7},
        "message_count": 3,
        "compression_format": "",
        "compression_mode": "NONE",
        "topics_with_message_count": [
            {
                "topic_metadata": {
                    **{"name": "/x", "type": "std_msgs/msg/String", "serialization_format": "cdr"},
                    "offered_qos_profiles": "- history: 3\n  depth: 0\n  reliability: 1\n  durability: 2\n",
                },
                "message_count": 3,
            }
        ],
    }
    whole = {"rosbag2_bagfile_information": old}
    read = from_yaml(yaml.safe_dump(whole), "metadata.yaml")
    assert (read.topics[0].qos[0].history, read.topics[0].qos[0].durability) == ("unknown", "volatile")
    assert (read.compression_mode, read.files[0].path, read.distro) == ("", "old_0.db3", "unknown")
    for key, value, sentence in [
        ("version", 99, "newer than 9"),
        ("message_count", None, None),
        ("duration", 5, "'duration' must be a mapping; found '5'"),
        ("storage_identifier", None, "'storage_identifier' must be a text; it is missing"),
        ("relative_file_paths", [1], "must be a list of file names"),
        ("topics_with_message_count", [{"message_count": 1}], "no 'topic_metadata'"),
    ]:
        changed = yaml.safe_dump({"rosbag2_bagfile_information": old | {key: value}})
        if sentence is None:
            from_yaml(changed, "metadata.yaml")
            continue
        with pytest.raises(BagError, match=sentence):
            from_yaml(changed, "metadata.yaml")
    with pytest.raises(BagError, match=r"metadata.yaml:2: this is not YAML"):
        from_yaml("a: b\n  c: [", "metadata.yaml")
    with pytest.raises(BagError, match="aliases"):
        from_yaml("a: &a [x]\nb: *a", "metadata.yaml")


def test_a_file_outside_of_the_bag_is_not_read(tmp_path):
    folder = write_bag(tmp_path / "c", count=2)
    text = (folder / "metadata.yaml").read_text()
    (tmp_path / "other.mcap").write_bytes((folder / "c_0.mcap").read_bytes())
    (folder / "metadata.yaml").write_text(text.replace("c_0.mcap", "../other.mcap"))
    with pytest.raises(BagError, match="is not in the folder of the bag"):
        Bag(folder)
    (folder / "metadata.yaml").write_text(text.replace("c_0.mcap", "gone.mcap"))
    with pytest.raises(BagError, match="none of its 1 files is there"):
        Bag(folder)
    (folder / "metadata.yaml").write_text("}")
    assert len(texts(Bag(folder))) == 2


def damaged(content, chance):
    """Change, cut, repeat or insert some bytes."""
    data = bytearray(content)
    for _ in range(chance.randint(1, 6)):
        place = chance.randrange(len(data) + 1)
        what = chance.randrange(6)
        if what == 0:
            del data[place:]
        elif what == 1:
            data[place : place + 8] = struct.pack("<Q", chance.choice([0, 1, 2**31, 2**63, 2**64 - 1]))
        elif what == 2:
            data[place:place] = chance.randbytes(chance.randint(1, 40))
        elif what == 3:
            del data[place : place + chance.randint(1, 60)]
        elif data and place < len(data):
            data[place] = chance.randrange(256)
        if not data:
            data = bytearray(b"\0")
    return bytes(data)


def read_damaged(tmp_path, cases):
    chance = random.Random(16)
    seeds = []
    for number, preset in enumerate(mcap_writing.PRESETS):
        folder = write_bag(tmp_path / f"seed{number}", count=12, preset=preset)
        seeds.append((folder / f"seed{number}_0.mcap").read_bytes())
    for mode in ("file", "message"):
        folder = write_bag(tmp_path / mode, count=12, compression=mode)
        seeds.append(next(folder.glob(f"{mode}_0.mcap*")).read_bytes())
    seeds.append(write_database(tmp_path / "seed.db3").read_bytes())
    text = (tmp_path / "seed0" / "metadata.yaml").read_bytes()
    path = tmp_path / "fuzzed"
    outcomes = {"read": 0, "refused": 0}
    for number in range(cases):
        try:
            if number % 10 == 0:
                from_yaml(damaged(text, chance).decode(errors="replace"), "metadata.yaml")
            else:
                path.write_bytes(damaged(chance.choice(seeds), chance))
                bag = Bag(path)
                for message in bag.messages():
                    assert isinstance(message.data, bytes)
                assert bag.metadata.count >= 0
            outcomes["read"] += 1
        except BagError as error:
            assert str(error)
            outcomes["refused"] += 1
    return outcomes


def test_damaged_bags_are_read_or_refused(tmp_path):
    outcomes = read_damaged(tmp_path, 150)
    assert all(outcomes.values()), outcomes


@pytest.mark.proof
def test_many_damaged_bags_are_read_or_refused(tmp_path):
    outcomes = read_damaged(tmp_path, FUZZED)
    assert all(outcomes.values()), outcomes
