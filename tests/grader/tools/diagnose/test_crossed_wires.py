"""Types, names, directions and policies that do not fit: what is said of one system that has all these faults."""

import pytest


@pytest.fixture(scope="module")
def told(diagnosed):
    return diagnosed(set_up)


def set_up(broken):
    from geometry_msgs.msg import Twist, TwistStamped
    from nav_msgs.msg import Odometry
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
    from sensor_msgs.msg import Imu, LaserScan, Range
    from std_msgs.msg import Bool, Float32, Float64, String

    broken.world(without=("Imu", "UserCommands"))
    broken.bridge(
        ("/drive", "/model/robot/cmd_vel", "geometry_msgs/msg/Twist", "gz.msgs.Twist", "GZ_TO_ROS"),
        ("/odom", "/model/robot/odometri", "nav_msgs/msg/Odometry", "gz.msgs.Odometry", "GZ_TO_ROS"),
        ("/twist", "/model/robot/odometry", "geometry_msgs/msg/Twist", "gz.msgs.Twist", "GZ_TO_ROS"),
        ("/wheels", "/modle/robot/cmd_vel", "geometry_msgs/msg/Twist", "gz.msgs.Twist", "ROS_TO_GZ"),
        ("/stop", "/stop", "std_msgs/msg/Bool", "gz.msgs.Boolean", "ROS_TO_GZ"),
        ("/horn", "/horn", "std_msgs/msg/String", "gz.msgs.StringMsg", "ROS_TO_GZ"),
        ("/imu", "/imu", "sensor_msgs/msg/Imu", "gz.msgs.IMU", "GZ_TO_ROS"),
        ("/camera", "/camera/image", "sensor_msgs/msg/Image", "gz.msgs.Image", "GZ_TO_ROS"),
    )
    from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
    from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

    outside = broken.gz_node()
    outside.subscribe(Boolean, "/stop", print)
    outside.subscribe(StringMsg, "/horn", print)

    shared = broken.context()
    teleop = broken.node("teleop", context=shared)
    teleop.create_publisher(Twist, "/drive", 10)
    teleop.create_publisher(Twist, "/wheels", 10)
    teleop.create_publisher(TwistStamped, "/turn", 10)
    teleop.create_publisher(Bool, "/stop", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    teleop.create_publisher(Float32, "/speeed", 10)
    teleop.create_publisher(Float32, "/unheard", 10)
    teleop.create_publisher(Range, "/map", QoSProfile(depth=1))

    listener = broken.node("listener")
    listener.create_subscription(Twist, "/turn", print, 10)
    listener.create_subscription(Float32, "/speed", print, 10)
    listener.create_subscription(Odometry, "/odom", print, 10)
    listener.create_subscription(LaserScan, "/scan", print, 10)
    listener.create_subscription(Float64, "/nowhere", print, 10)
    listener.create_subscription(Imu, "/imu", print, 10)
    durable = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    listener.create_subscription(Range, "/map", print, durable)

    broken.node("sleeper", spins=False).create_publisher(String, "/dreams", 10)
    broken.node("waiting", sim_time=True)
    broken.node("twin", context=shared)
    broken.node("twin")


def sentences(told, kind):
    return [finding.sentence for finding in told.of(kind)]


def test_two_types_on_a_topic(told):
    assert told.sentence("type_clash") == (
        "/teleop publishes geometry_msgs/msg/TwistStamped on /turn, but /listener listens for geometry_msgs/msg/Twist: "
        "no message arrives."
    )
    assert len(told.of("type_clash")) == 1


def test_another_type_in_gazebo(told):
    assert sentences(told, "gz_type_clash") == [
        "The bridge /ros_gz_bridge has gz.msgs.Twist for /model/robot/odometry, but Gazebo publishes gz.msgs.Odometry "
        "there: no message passes."
    ]
    assert "gz_type_name: gz.msgs.Odometry" in told.fix("gz_type_clash")


def test_the_wrong_direction(told):
    assert sentences(told, "wrong_direction") == [
        "The bridge /ros_gz_bridge carries /model/robot/cmd_vel from Gazebo to ROS, but Gazebo listens on it: "
        "the direction is wrong."
    ]
    assert "direction: ROS_TO_GZ" in told.fix("wrong_direction")


def test_a_gazebo_topic_nobody_publishes_names_the_nearest(told):
    assert told.sentence("nobody_publishes") == (
        "The bridge /ros_gz_bridge waits for /model/robot/odometri from Gazebo, but nobody publishes it there."
    )
    assert told.fix("nobody_publishes") == "Did you mean /model/robot/odometry? Correct the bridge's gz_topic_name."


def test_a_gazebo_topic_nobody_listens_to_names_the_nearest(told):
    assert told.sentence("nobody_listens") == (
        "The bridge /ros_gz_bridge publishes /modle/robot/cmd_vel in Gazebo, but nobody there listens."
    )
    assert told.fix("nobody_listens").startswith("Did you mean /model/robot/cmd_vel?")


def test_ros_topics_without_a_publisher(told):
    found = {finding.sentence: finding.fix for finding in told.of("nobody_publishes")}
    speed = "/listener listens on /speed (std_msgs/msg/Float32), but nobody publishes it."
    assert found[speed] == "Did you mean /speeed? Correct the name or remap it."
    assert found["/listener listens on /nowhere (std_msgs/msg/Float64), but nobody publishes it."].startswith("Start")


def test_ros_topics_without_a_listener(told):
    found = {finding.sentence: finding for finding in told.of("nobody_listens")}
    near = found["/teleop publishes /speeed (std_msgs/msg/Float32), but nobody listens."]
    assert (near.severity.name, near.fix) == ("ERROR", "Did you mean /speed? Correct the name or remap it.")
    assert found["/teleop publishes /unheard (std_msgs/msg/Float32), but nobody listens."].severity.name == "NOTE"


def test_a_symptom_is_not_told_beside_its_cause(told):
    said = " ".join(sentences(told, "nobody_publishes") + sentences(told, "nobody_listens"))
    assert "/drive" not in said and "/teleop publishes /wheels" not in said
    assert "on /scan" not in said, "not_bridged tells it"


def test_a_topic_that_a_bridge_waits_for(told):
    found = {finding.sentence: finding.severity.name for finding in told.of("nobody_publishes")}
    sentence = "The bridge /ros_gz_bridge waits for /horn (std_msgs/msg/String), but nobody in ROS publishes it."
    assert found[sentence] == "ERROR", "/dreams carries the same type and nobody hears it"


def test_a_topic_that_lacks_a_bridge(told):
    assert sentences(told, "not_bridged") == [
        "/listener listens on /scan in ROS and Gazebo publishes /lidar/scan, but no bridge carries it."
    ]
    assert "'/lidar/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan' --ros-args -r /lidar/scan:=/scan" in told.fix(
        "not_bridged"
    )


def test_reliability_that_cannot_match(told):
    assert (
        "On /stop /teleop offers reliability BEST_EFFORT, but /ros_gz_bridge asks for RELIABLE: no message arrives."
        in sentences(told, "qos")
    )
    fixes = [finding.fix for finding in told.of("qos")]
    assert any("qos_overrides./stop.subscription.reliability:=best_effort" in fix for fix in fixes)


def test_durability_that_cannot_match(told):
    assert (
        "On /map /teleop offers durability VOLATILE, but /listener asks for TRANSIENT_LOCAL: no message arrives."
        in sentences(told, "qos")
    )
    assert len(told.of("qos")) == 2


def test_a_sensor_without_its_system(told):
    (sentence,) = sentences(told, "missing_system")
    assert sentence.startswith("The world room has the sensor robot/") and "but not the system Imu" in sentence
    assert "filename='gz-sim-imu-system' name='gz::sim::systems::Imu'" in told.fix("missing_system")


def test_a_world_nothing_can_be_spawned_into(told):
    assert sentences(told, "no_create_service") == [
        "The world room has no service /world/room/create: nothing can be spawned into it."
    ]


def test_simulated_time_without_a_clock(told):
    assert sentences(told, "no_clock") == [
        "/waiting has use_sim_time, but nobody publishes /clock: the time stays 0 and timers never fire."
    ]
    assert "parameter_bridge '/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock'" in told.fix("no_clock")


def test_a_node_that_never_spins(told):
    assert sentences(told, "no_answer") == [
        "/sleeper does not answer: it never spins, is stuck in a callback, or its process was killed."
    ]


def test_two_nodes_of_one_name(told):
    assert sentences(told, "same_node_name") == ["2 nodes are called /twin: what is meant for one may reach the other."]


def test_the_worst_comes_first(told):
    severities = [finding.severity for finding in told.findings]
    assert severities == sorted(severities)
    assert told.findings[0].kind == "no_clock"
    assert told.diagnosis.wrong
