"""Shapes of bridge files as people publish them: what the original takes is taken, and each fault is named."""

import pytest

from gz_course.sim.bridge.ros_gz_bridge.parameter_bridge import configured
from gz_course.sim.bridge.ros_gz_bridge.parameters import DEFAULTS, Parameters
from gz_course.sim.ros.ros_program.errors import UsageError

QUOTED = """\
---
# the clock of the simulation, ünïcode in a remark
- ros_topic_name: "/clock"
  gz_topic_name: "/clock"
  ros_type_name: "rosgraph_msgs/msg/Clock"
  gz_type_name: "gz.msgs.Clock"
  direction: GZ_TO_ROS
"""
LASER = """\
- gz_type_name: gz.msgs.LaserScan
  gz_topic_name: "world/{world}/model/{model}/link/{link}/sensor/{sensor}/scan"
  lazy: true   # only while somebody listens
  ros_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  direction: "GZ_TO_ROS"
"""
TWIST = """\
- topic_name: /model/robot/cmd_vel
  ros_type_name: geometry_msgs/msg/Twist
  gz_type_name: gz.msgs.Twist
  direction: ROS_TO_GZ
"""


def with_key(bridge, *lines):
    return bridge + "".join(f"  {line}\n" for line in lines)


def with_type(bridge, ros, gz):
    return bridge.replace("geometry_msgs/msg/Twist", ros).replace("gz.msgs.Twist", gz)


# The file, how many bridges are made of it, what is said, and whether a part was left out ("error") or not ("warning").
TAKEN = {
    "quoted texts after a remark": (QUOTED, 1, [], ""),
    "keys in any order, braces in a Gazebo name": (LASER, 1, [], ""),
    "one name for both sides, no newline at the end": (TWIST.rstrip(), 1, [], ""),
    "several bridges": (QUOTED + "\n\n" + LASER + "\n#- commented: out\n" + TWIST, 3, [], ""),
    "flow style": ("[{topic_name: /a, ros_type_name: std_msgs/msg/Bool, gz_type_name: gz.msgs.Boolean}]", 1, [], ""),
    "queues": (with_key(LASER, "subscriber_queue: 1", "publisher_queue: 1"), 1, ["changes nothing"], "warning"),
    "a quoted number": (with_key(LASER, 'publisher_queue: "5"'), 1, [], ""),
    "a queue of 0": (with_key(LASER, "publisher_queue: 0"), 1, ["x.yaml:7: 'publisher_queue' must be"], "warning"),
    "a quoted truth value": (with_key(TWIST, "lazy: 'false'"), 1, ["x.yaml:5: 'lazy' must be true or"], "warning"),
    "y for true": (with_key(TWIST, "lazy: n"), 1, ["'lazy' must be true or false, not n"], "warning"),
    "a frame": (with_key(LASER, "frame_id: lidar_link"), 1, [], ""),
    "a QoS profile": (with_key(LASER, "qos_profile: SENSOR_DATA"), 1, ["newer releases than Jazzy"], "warning"),
    "an unknown QoS profile": (
        with_key(LASER, "qos_profile: SENSORDATA"), 1, ["did you mean 'SENSOR_DATA'"], "warning"
    ),
    "the older prefix": (TWIST.replace("gz.msgs", "ignition.msgs"), 1, ["write gz.msgs.Twist"], "warning"),
    "an unknown key": (with_key(TWIST, "directon: x"), 1, ["x.yaml:5", "did you mean 'direction'?"], "warning"),
    "an unknown key with a list below": (
        with_key(LASER, "ros_qos_info:", "  reliability: BEST_EFFORT", "  depth: 5"),
        1, ["x.yaml:7: the key 'ros_qos_info' is not known"], "warning",
    ),
    "an unknown key with a key below": (
        with_key(LASER, "ros:", "  frame_id: lidar"), 1, ["x.yaml:7: the key 'ros' is not known"], "warning"
    ),
    "a key that is a list": (with_key(TWIST, "? [a, b]", ": 1"), 1, ["a key must be one of"], "warning"),
    "a merge": (with_key(TWIST, "<<: {lazy: true}"), 1, ["'<<' merges nothing"], "warning"),
    "a repeated key": (with_key(TWIST, "direction: GZ_TO_ROS"), 1, ["x.yaml:5", "in line 4, which counts"], "warning"),
    "a repeated bridge": (QUOTED + QUOTED.removeprefix("---\n"), 2, ["x.yaml:9: bridges /clock again"], "warning"),
    "the clock both ways": (QUOTED.replace("GZ_TO_ROS", "BIDIRECTIONAL"), 1, ["keeps its own clock"], "warning"),
    "a camera picture to Gazebo": (
        with_type(TWIST, "sensor_msgs/msg/Image", "gz.msgs.Image"), 1, ["did you mean [ or direction"], "warning"
    ),
    "points to Gazebo": (
        with_type(TWIST, "sensor_msgs/msg/PointCloud2", "gz.msgs.PointCloudPacked"), 1, ["Gazebo publishes"], "warning"
    ),
    "an empty name beside a name": (
        LASER + "  topic_name: ''\n", 1, ["x.yaml:7: 'topic_name' must be a text, not nothing; leave"], "warning"
    ),
    "a second document": (TWIST + "---\n" + QUOTED.removeprefix("---\n"), 1, ["x.yaml:7: a second doc"], "warning"),
    "an unknown pair": (
        QUOTED + with_type(TWIST, "std_msgs/msg/Imu", "gz.msgs.IMU"), 1,
        ["x.yaml:9: no conversion is known for std_msgs/msg/Imu; gz.msgs.IMU pairs with sensor_msgs/msg/Imu"], "error",
    ),
    "a Gazebo type of its own": (
        QUOTED + TWIST.replace("gz.msgs.Twist", "gz.sensor_msgs.Twist"), 1, ["pairs with gz.msgs.Twist"], "error"
    ),
    "a ROS 1 type": (QUOTED + TWIST.replace("/msg/", "/"), 1, ["(package/msg/Name)", "geometry_msgs/msg/Tw"], "error"),
    "an underscore in the prefix": (QUOTED + TWIST.replace("gz.msgs", "gz_msgs"), 1, ["write gz.msgs.Twist"], "error"),
    "types without their keys": (
        QUOTED + "- topic_name: /odom\n  ros_type: nav_msgs/msg/Odometry\n  gz_type: gz.msgs.Odometry\n", 1,
        ["x.yaml:8: 'ros_type_name' is missing", "did you mean 'ros_type_name'?"], "error",
    ),
    "keys of one's own": (
        QUOTED + "- ros_topic: /odom\n  gz_topic: /odom\n  ros_type: nav_msgs/msg/Odometry\n  lazy: maybe\n", 1,
        ["x.yaml:8: the topic is missing", "did you mean 'ros_topic_name'?"], "error",
    ),
    "a name that ROS refuses, of an unknown type": (
        QUOTED + with_type(TWIST, "my_msgs/msg/Mine", "gz.msgs.Mine").replace("/cmd_vel", "/cmd vel"), 1,
        ["x.yaml:8: '/model/robot/cmd vel' is not a ROS topic name"], "error",
    ),
    "the keys of Fortress": (
        QUOTED + LASER.replace("gz_t", "ign_t"), 1, ["did you mean 'gz_topic_name'", "'gz_type_name' is mis"], "error"
    ),
    "directions of Fortress": (QUOTED + LASER.replace("GZ_TO", "IGN_TO"), 1, ["'IGN_TO_ROS' is none of"], "error"),
    "a direction in lower case": (QUOTED + TWIST.replace("ROS_TO_GZ", "ros_to_gz"), 1, ["mean 'ROS_TO"], "error"),
    "no direction after the colon": (QUOTED + TWIST.replace(" ROS_TO_GZ", ""), 1, ["not nothing"], "error"),
    "one name and a name of one side": (
        QUOTED + TWIST.replace("- t", "- gz_topic_name: /b\n  t"), 1, ["exclude each other"], "error"
    ),
    "an empty type": (QUOTED + TWIST.replace("gz.msgs.Twist", '""'), 1, ["'gz_type_name' must be a text"], "error"),
    "a private Gazebo name": (
        QUOTED + TWIST.replace("topic_name: /model/robot/", 'ros_topic_name: a\n  gz_topic_name: ~/'), 1,
        ["works only with the parameter expand_gz_topic_names"], "error",
    ),
    "a bridge that is a text": (QUOTED + "- /go@geometry_msgs/msg/Twist]gz.msgs.Twist\n", 1, ["x.yaml:8"], "error"),
    "two types on a ROS topic": (
        TWIST + with_type(TWIST, "std_msgs/msg/Bool", "gz.msgs.Boolean"), 1, ["x.yaml:5", "one type"], "error"
    ),
    "a file of parameters": ("ros__parameters:\n  bridges:\n    - topic_name: /a\n", 0, ["expected a list"], "error"),
    "an empty file": ("", 0, ["the file is empty"], "error"),
    "only remarks": ("# later\n", 0, ["the file is empty"], "error"),
    "an empty list": ("[]", 0, ["the list of bridges is empty"], "warning"),
}  # fmt: skip

# Files at which the original ends, and what is said here.
REFUSED = {
    "tabs": (QUOTED.replace("  ", "\t"), "indented with spaces, never with tabs"),
    "a quotation mark that stays open": (QUOTED.replace('"/clock"', '"/clock', 1), "not valid YAML"),
    "no space after the colon": (TWIST.replace("direction: ", "direction:"), "a space is missing after the colon"),
    "a ROS name with a space": (TWIST.replace("/cmd_vel", "/cmd vel"), "is not a ROS topic name"),
    "no name": (TWIST.replace("topic_name: /model/robot/cmd_vel\n  ", ""), "the topic is missing"),
    "a list as a name": (TWIST.replace("/model/robot/cmd_vel", "[/a, /b]"), "must be a text, not a list"),
    "a queue in words": (with_key(TWIST, "subscriber_queue: ten"), "must be a number of messages"),
    "lazy in words": (with_key(TWIST, "lazy: maybe"), "'lazy' must be true or false"),
    "nothing for lazy": (with_key(TWIST, "lazy:"), "'lazy' must be true or false"),
}


def read(tmp_path, text, *, strict=False):
    file = tmp_path / "x.yaml"
    file.write_text(text)
    return configured(None, [], Parameters(DEFAULTS | {"config_file": str(file)}), strict=strict)


@pytest.mark.parametrize("shape", TAKEN)
def test_what_the_original_takes_is_taken(shape, tmp_path):
    text, bridges, words, kind = TAKEN[shape]
    config, errors = read(tmp_path, text)
    assert len(config.topics) == bridges
    said = [*errors, *map(str, config.findings)]
    assert all(any(word in sentence for sentence in said) for word in words), said
    assert bool(errors) == (kind == "error")
    assert bool(config.findings or errors) == bool(kind)
    assert all("\n" not in sentence for sentence in errors)


@pytest.mark.parametrize("shape", TAKEN)
def test_strict_refuses_the_whole_for_one_error(shape, tmp_path):
    text, _, words, _ = TAKEN[shape]
    config, errors = read(tmp_path, text)
    if errors or any(not finding.warning for finding in config.findings):
        with pytest.raises(UsageError) as caught:
            read(tmp_path, text, strict=True)
        assert all(any(word in sentence for sentence in caught.value.sentences) for word in words)
    else:
        assert read(tmp_path, text, strict=True)[0].topics == config.topics


@pytest.mark.parametrize("shape", REFUSED)
def test_where_the_original_ends_nothing_is_started(shape, tmp_path):
    text, words = REFUSED[shape]
    with pytest.raises(UsageError) as caught:
        read(tmp_path, text)
    assert any(sentence.startswith(f"{tmp_path}/x.yaml:") and words in sentence for sentence in caught.value.sentences)


def test_a_missing_file_is_reported_and_the_bridge_waits(tmp_path):
    config, errors = configured(None, [], Parameters(DEFAULTS | {"config_file": "/none.yaml"}), strict=False)
    assert config.topics == []
    assert errors == ["/none.yaml: cannot read the bridge configuration: No such file or directory"]


GOOD = "/a@std_msgs/msg/Bool@gz.msgs.Boolean"


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ("/b@std_msgs/String[gz.msgs.StringMsg", "pairs with std_msgs/msg/String"),
        ("/b@std_msgs/msg/Bool[gz.msgs.Boolen", "std_msgs/msg/Bool pairs with gz.msgs.Boolean"),
        ("/b@std_msgs/msg/Bool", "has no direction and no Gazebo type"),
        ("/b@no_such/srv/Control", "no conversion is known for the service"),
    ],
)
def test_an_argument_without_conversion_is_left_out(argument, words):
    config, (error,) = configured(None, [GOOD, argument], Parameters(), strict=False)
    assert [entry.ros_topic for entry in config.topics] == ["/a"]
    assert error.startswith(f"argument '{argument}': ") and words in error


@pytest.mark.parametrize("argument", ["/b", "@b", "/b@std_msgs/msg/Bool[", f"{GOOD}@x", "/b@x/srv/Y[z", "/b c@d@e"])
def test_a_malformed_argument_is_refused(argument):
    with pytest.raises(UsageError):
        configured(None, [GOOD, argument], Parameters(), strict=False)
