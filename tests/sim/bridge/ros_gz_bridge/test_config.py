"""The configuration is read like in ros_gz_bridge, and every fault is reported with its place."""

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.config import MAX_BYTES, ConfigError, load_yaml, read_yaml
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.tests.sim.bridge.ros_gz_bridge.reading import parse_argument, parse_arguments, parse_yaml

PAIRS = [(pair.ros_type, pair.gz_type) for pair in type_pairs.pairs()]
MARKS = {"@": Direction.BIDIRECTIONAL, "[": Direction.GZ_TO_ROS, "]": Direction.ROS_TO_GZ}

ONE_NAME = """\
# one name for both sides
---
- topic_name: /cmd_vel
  ros_type_name: geometry_msgs/msg/Twist
  gz_type_name: gz.msgs.Twist
  direction: ROS_TO_GZ
- topic_name: /camera/image_raw
  ros_type_name: sensor_msgs/msg/Image
  gz_type_name: gz.msgs.Image
  direction: GZ_TO_ROS
"""

TWO_NAMES = """\
- ros_topic_name: "/cmd_vel"
  gz_topic_name: "/model/my_robot/cmd_vel"
  ros_type_name: "geometry_msgs/msg/Twist"
  gz_type_name: "ignition.msgs.Twist"
  direction: ROS_TO_GZ

- ros_topic_name: "/imu/data"
  gz_topic_name: "/imu"
  ros_type_name: "sensor_msgs/msg/Imu"
  gz_type_name: "gz.msgs.IMU"
  direction: GZ_TO_ROS
  publisher_queue: 5
  subscriber_queue: 3
  lazy: true
  frame_id: imu_link
"""

names = st.from_regex(r"/?[A-Za-z][A-Za-z0-9]{0,6}(/[A-Za-z][A-Za-z0-9]{0,6}){0,2}", fullmatch=True)


def errors_of(text, **options):
    with pytest.raises(ConfigError) as caught:
        parse_yaml(text, "b.yaml", **options)
    return caught.value.errors


def bridge(**changes):
    """Return the YAML of a valid bridge with some keys changed; None omits a key."""
    keys = {
        "topic_name": "/scan",
        "ros_type_name": "sensor_msgs/msg/LaserScan",
        "gz_type_name": "gz.msgs.LaserScan",
        "direction": "GZ_TO_ROS",
    } | changes
    return "- " + "  ".join(f"{key}: {value}\n" for key, value in keys.items() if value is not None)


def test_one_name_for_both_sides():
    assert parse_yaml(ONE_NAME, "b.yaml") == [
        BridgeEntry(
            "/cmd_vel",
            "/cmd_vel",
            "geometry_msgs/msg/Twist",
            "gz.msgs.Twist",
            Direction.ROS_TO_GZ,
            source="b.yaml:3",
        ),
        BridgeEntry(
            "/camera/image_raw",
            "/camera/image_raw",
            "sensor_msgs/msg/Image",
            "gz.msgs.Image",
            Direction.GZ_TO_ROS,
            source="b.yaml:7",
        ),
    ]


def test_a_name_for_each_side_and_every_option(tmp_path):
    file = tmp_path / "b.yaml"
    file.write_text(TWO_NAMES)
    first, second = load_yaml(file)
    assert (first.ros_topic, first.gz_topic, first.gz_type) == (
        "/cmd_vel",
        "/model/my_robot/cmd_vel",
        "gz.msgs.Twist",
    )
    assert second == BridgeEntry(
        "/imu/data",
        "/imu",
        "sensor_msgs/msg/Imu",
        "gz.msgs.IMU",
        Direction.GZ_TO_ROS,
        5,
        3,
        True,
        "imu_link",
        f"{file}:7",
    )


def test_defaults():
    (entry,) = parse_yaml(bridge(direction=None))
    assert (entry.direction, entry.publisher_queue, entry.subscriber_queue) == (
        Direction.BIDIRECTIONAL,
        10,
        10,
    )
    assert (entry.lazy, entry.frame_id) == (False, None)
    (one_sided,) = parse_yaml(bridge(topic_name=None, gz_topic_name="/lidar"))
    assert (one_sided.ros_topic, one_sided.gz_topic) == ("/lidar", "/lidar")
    assert parse_yaml(bridge(), lazy=True)[0].lazy
    assert not parse_yaml(bridge(lazy="false"), lazy=True)[0].lazy
    assert parse_yaml("[]") == []


entries = st.builds(
    lambda topics, pair, direction, queues, lazy, frame: BridgeEntry(
        *topics, *pair, direction, *queues, lazy, frame or None, source=""
    ),
    st.tuples(names, names),
    st.sampled_from(PAIRS),
    st.sampled_from(list(Direction)),
    st.tuples(st.integers(1, 5000), st.integers(1, 5000)),
    st.booleans(),
    st.text("abc:/ '\"#-", max_size=8),
)


@given(st.lists(entries, max_size=5, unique_by=lambda entry: (entry.ros_topic, entry.gz_topic)))
def test_what_is_written_is_read(written):
    text = yaml.safe_dump(
        [
            {
                "ros_topic_name": entry.ros_topic,
                "gz_topic_name": entry.gz_topic,
                "ros_type_name": entry.ros_type,
                "gz_type_name": entry.gz_type,
                "direction": entry.direction.value,
                "publisher_queue": entry.publisher_queue,
                "subscriber_queue": entry.subscriber_queue,
                "lazy": entry.lazy,
            }
            | ({} if entry.frame_id is None else {"frame_id": entry.frame_id})
            for entry in written
        ]
    )
    read = read_yaml(text, "x").topics  # the plausibility of such bridges is checked elsewhere
    assert [BridgeEntry(**(vars(entry) | {"source": ""})) for entry in read] == written


@given(st.one_of(st.text(), st.binary(), st.text("-[]{}:,&*!|>'\"%@` \n\tabc0", max_size=60)))
@example("*a")
@example("&a [*a]")
@example("- !!python/object/apply:os.system [x]")
@example("- {? [a]: b}")
@example("a: 1\n---\nb: 2")
@example("- 2020-99-99")
@example("\0")
@example(b"\xff\xfe")
def test_no_text_does_worse_than_a_config_error(text):
    try:
        parse_yaml(text, "b.yaml")
    except ConfigError as error:
        assert error.errors
        assert all(sentence.startswith("b.yaml") and "\n" not in sentence for sentence in error.errors)


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("", "b.yaml:", "the file is empty"),
        ("# nothing\n", "b.yaml:", "the file is empty"),
        ("topic_name: /a\n", "b.yaml:1:", "expected a list of bridges, found a mapping"),
        ("hello", "b.yaml:1:", "expected a list of bridges, found the text 'hello'"),
        ("- 1\n", "b.yaml:1:", "expected a bridge (lines of 'key: value'), found the text '1'"),
        ("-\n", "b.yaml:1:", "found nothing"),
        ("- a: [\n", "b.yaml:2:", "not valid YAML"),
        ("- a: /b\n   c: d\n", "b.yaml:2:", "it is indented further than line 1"),
        ("- a = /b\n  c: d\n", "b.yaml:2:", "there is no colon in line 1"),
        ("- a: /b\n  c:d\n  e: f\n", "b.yaml:2:", "a space is missing after the colon"),
        ("- a: '/b\n  c: d\n", "b.yaml:1:", "a quotation mark that opens here is never closed"),
        (
            bridge(directon="GZ_TO_ROS"),
            "b.yaml:5:",
            "the key 'directon' is not known; did you mean 'direction'?",
        ),
        (bridge(gz_topic="/a"), "b.yaml:5:", "the key 'gz_topic' is not known; did you mean 'gz_topic_name'?"),
        (bridge(zzz="1"), "b.yaml:5:", "the key 'zzz' is not known; known keys: topic_name"),
        (
            bridge(direction="gz_to_ros"),
            "b.yaml:4:",
            "'gz_to_ros' is none of BIDIRECTIONAL, GZ_TO_ROS, ROS_TO_GZ; did",
        ),
        (bridge(direction="[]"), "b.yaml:4:", "'direction' must be a text, not a list"),
        (bridge(ros_type_name=None), "b.yaml:1:", "'ros_type_name' is missing"),
        (bridge(gz_type_name=None), "b.yaml:1:", "'gz_type_name' is missing"),
        (bridge(gz_type_name=""), "b.yaml:3:", "'gz_type_name' must be a text, not nothing"),
        (
            bridge(gz_type_name="gz.msgs.Laserscan"),
            "b.yaml:2:",
            "sensor_msgs/msg/LaserScan pairs with gz.msgs.LaserScan",
        ),
        (bridge(topic_name=None), "b.yaml:1:", "the topic is missing"),
        (bridge(ros_topic_name="/a"), "b.yaml:1:", "'topic_name' and 'ros_topic_name' exclude each other"),
        (bridge(topic_name="/a//b"), "b.yaml:1:", "is not a ROS topic name"),
        (bridge(topic_name="/1a"), "b.yaml:1:", "is not a ROS topic name"),
        (
            bridge(topic_name=None, ros_topic_name="/a", gz_topic_name="'/a b'"),
            "b.yaml:5:",
            "is not a Gazebo topic name",
        ),
        (bridge(lazy="maybe"), "b.yaml:5:", "'lazy' must be true or false, not maybe"),
        (
            bridge(publisher_queue="0"),
            "b.yaml:5:",
            "'publisher_queue' must be a number of messages from 1 to 999999, not 0",
        ),
        (bridge(subscriber_queue="ten"), "b.yaml:5:", "'subscriber_queue' must be a number of messages"),
        (
            bridge() + "  direction: ROS_TO_GZ\n",
            "b.yaml:5:",
            "'direction' is given twice (first in line 4, which counts)",
        ),
        (bridge() + "-topic_name: /a\n", "b.yaml:5:", "a space is missing after the dash"),
        (bridge() + "  lazy = true\n", "b.yaml:5:", "a colon and a space, and no ="),
        (bridge() + "  lazy: true direction: BOTH\n", "b.yaml:5:", "two colons stand in this line"),
        (bridge() + "  lazy: @yes\n", "b.yaml:5:", "needs quotation marks"),
        ("  topic_name: /a\n" + bridge(), "b.yaml:2:", "the dash of the first entry, above, is missing"),
        ("- {topic_name: /a lazy: true}\n", "b.yaml:1:", "a comma is missing between two keys"),
        ("- {topic_name: /a}}\n", "b.yaml:1:", "that nothing has opened"),
        ("- {topic_name: /a\n- {topic_name: /b}\n", "b.yaml:2:", "is never closed"),
        (
            bridge() + bridge().replace("- ", "  "),
            "b.yaml:5:",
            "a dash is missing here, '- ",
        ),
        (
            bridge().replace("  gz_type_name", "- gz_type_name"),
            "b.yaml:3:",
            "the dash before 'gz_type_name' begins another bridge, so the one above is a part of one",
        ),
        (bridge() + "- lazy: true\n", "b.yaml:5:", "so what follows is a part of one"),
        ("".join(f"- {line[2:]}\n" for line in bridge().splitlines()), "b.yaml:1:", "each dash begins another bridge"),
        ("[" * 5000, "b.yaml", "nested too deeply"),
        ("[" + "a, " * 1001 + "]", "b.yaml", "1001 bridges, more than the 1000"),
        (" " * (MAX_BYTES + 1), "b.yaml", "larger than 256 KiB"),
    ],
)
def test_each_fault_has_its_sentence_and_place(text, place, words):
    (sentence,) = errors_of(text)
    assert sentence.startswith(place)
    assert words in sentence


def test_merge_keys_are_keys_like_others_for_yaml_cpp():
    merged = bridge().replace("- ", "- &scan\n  ", 1) + "- <<: *scan\n  topic_name: /b\n"
    assert "'<<' merges nothing in a bridge's file" in errors_of(merged)[0]


def test_an_alias_bomb_is_only_a_list_of_wrong_items():
    bomb = "- &a [x, x]\n" + "".join(f"- &{chr(98 + i)} [*{chr(97 + i)}, *{chr(97 + i)}]\n" for i in range(20))
    assert len(errors_of(bomb)) == 21


def test_all_faults_are_listed_at_once():
    text = bridge(direction="UP", lazy="perhaps") + bridge(topic_name=None, ros_type_name="std_msgs/msg/Bol") + "- 5\n"
    errors = errors_of(text)
    assert [error.split(": ")[0] for error in errors] == [
        "b.yaml:4",
        "b.yaml:5",
        "b.yaml:6",
        "b.yaml:6",
        "b.yaml:9",
    ]


def test_a_missing_file_and_a_folder(tmp_path):
    for path in (tmp_path / "none.yaml", tmp_path):
        with pytest.raises(ConfigError, match="cannot read the bridge configuration"):
            load_yaml(path)


@given(names, st.sampled_from(PAIRS), st.sampled_from(sorted(MARKS)))
def test_every_argument_of_the_right_form_is_read(topic, pair, mark):
    text = f"{topic}@{pair[0]}{mark}{pair[1]}"
    assert parse_argument(text) == BridgeEntry(topic, topic, *pair, MARKS[mark], source=f"argument '{text}'")


@given(st.text("@[]/ab_. ", max_size=30))
def test_no_argument_does_worse_than_a_config_error(text):
    with pytest.raises(ConfigError):
        parse_argument(text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("/scan", "has no '@'"),
        ("@std_msgs/msg/Bool@gz.msgs.Boolean", "the topic name before the first '@' is missing"),
        (
            "/a@std_msgs/msg/Bool",
            "has no direction and no Gazebo type; .* /a@std_msgs/msg/Bool@gz.msgs.Boolean",
        ),
        ("/a@std_msgs/msg/Bool[", "the Gazebo type after the direction mark is missing"),
        ("/a@std_msgs/msg/Bool@gz.msgs.Boolean@", "one direction mark is enough"),
        ("/a@std_msgs/msg/Bool[gz.msgs.Bool", "std_msgs/msg/Bool pairs with gz.msgs.Boolean"),
        ("/a@std_msgs/Bool@gz.msgs.Boolean", "pairs with std_msgs/msg/Bool"),
        ("/a b@std_msgs/msg/Bool@gz.msgs.Boolean", "not a ROS topic name"),
        ("/w/control@no_such/srv/Control@a@b", "no conversion is known for the service no_such/srv/Control"),
        ("/w/control@no_such/srv/Control[a", "is not a service bridge; expected SERVICE@ROS_TYPE"),
        ("@no_such/srv/Control", "the service name before the first '@' is missing"),
        ("/a@std_msgs/msg/Bool@gz_msgs.Boolean", "'gz_msgs.Boolean' is not a Gazebo type; write gz.msgs.Boolean"),
    ],
)
def test_each_fault_of_an_argument(text, words):
    with pytest.raises(ConfigError, match=words):
        parse_argument(text)


def test_faults_of_all_arguments_are_listed_at_once():
    good = "/a@std_msgs/msg/Bool@gz.msgs.Boolean"
    assert len(parse_arguments([good, good.replace("/a", "/b", 1)])) == 2
    with pytest.raises(ConfigError) as caught:
        parse_arguments([good, "x", "y", "/c@std_msgs/msg/Bool"])
    assert len(caught.value.errors) == 3
