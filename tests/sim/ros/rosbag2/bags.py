"""Bags for tests: written by the recorder's writer, or as rosbag2's older storage writes them."""

import contextlib
import sqlite3
import struct

from gz_course.sim.ros.rosbag2.definitions import definition
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.storage.metadata import Topic
from gz_course.sim.ros.rosbag2.storage.offered_qos import QosProfile

START = 1_700_000_000_000_000_000  # [ns]
STEP = 10_000_000  # [ns]
CHATTER = Topic(
    "/chatter",
    "std_msgs/msg/String",
    qos=(QosProfile(reliability="best_effort", durability="transient_local"),),
    type_hash="RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
)
SAID = Topic("/chatter", "std_msgs/msg/String", qos=(QosProfile(),))
TWIST = Topic("/cmd_vel", "geometry_msgs/msg/Twist", qos=(QosProfile(),))


def string(text):
    """The CDR of a std_msgs/String."""
    raw = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(raw)) + raw


def twist(x):
    return b"\0\1\0\0" + struct.pack("<6d", x, 0, 0, 0, 0, 0)


def write_bag(folder, count=100, topics=(CHATTER, TWIST), **options):
    """Write messages on both topics, in turn."""
    writer = BagWriter(folder, **options)
    for topic in topics:
        writer.add_topic(topic, definition(topic.type))
    for number in range(count):
        topic = topics[number % len(topics)]
        data = string(f"message {number}") if topic.type == CHATTER.type else twist(number)
        writer.write(topic.name, START + number * STEP, START + number * STEP - 5, data)
    writer.close()
    return folder


def write_database(path, with_definitions=True, count=10):
    """Write a `.db3` file with the tables of Jazzy, or with those of Foxy."""
    new = ", type_description_hash TEXT NOT NULL" if with_definitions else ""
    with contextlib.closing(sqlite3.connect(path)) as database, database:
        database.execute(
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
            f"serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL{new})"
        )
        database.execute(
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
            "timestamp INTEGER NOT NULL, data BLOB NOT NULL)"
        )
        qos = "- history: 1\n  depth: 7\n  reliability: 2\n  durability: 1\n  deadline:\n    sec: 2147483647\n"
        qos += "    nsec: 4294967295\n  lifespan:\n    sec: 2147483647\n    nsec: 4294967295\n  liveliness: 1\n"
        qos += "  liveliness_lease_duration:\n    sec: 2147483647\n    nsec: 4294967295\n"
        qos += "  avoid_ros_namespace_conventions: false\n"
        row = (1, CHATTER.name, CHATTER.type, "cdr", qos, *([CHATTER.type_hash] if with_definitions else []))
        database.execute(f"INSERT INTO topics VALUES ({', '.join('?' * len(row))})", row)
        for number in range(count):
            data = string(f"message {number}")
            database.execute("INSERT INTO messages VALUES (NULL, 1, ?, ?)", (START + number * STEP, data))
        if with_definitions:
            database.execute(
                "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT "
                "NOT NULL, encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL)"
            )
            encoding, text = definition(CHATTER.type)
            row = (CHATTER.type, encoding, text, CHATTER.type_hash)
            database.execute("INSERT INTO message_definitions VALUES (NULL, ?, ?, ?, ?)", row)
    database.close()
    return path
