"""Clocks, pauses, stamps, frames and a robot that drives on: messages flow and mean the wrong thing."""

import threading

import pytest

CLOCK = ("/clock", "/clock", "rosgraph_msgs/msg/Clock", "gz.msgs.Clock", "GZ_TO_ROS")
DEADLINE = 120.0


@pytest.fixture(scope="module")
def driving(diagnosed):
    return diagnosed(set_up_driving)


def set_up_driving(broken):
    """A robot that was told to drive once, and a node that stamps and frames badly."""
    from nav_msgs.msg import Odometry
    from rclpy.qos import QoSPresetProfiles
    from sensor_msgs.msg import Imu, LaserScan, Range

    server = broken.world()
    broken.bridge(
        CLOCK,
        ("/odom", "/model/robot/odometry", "nav_msgs/msg/Odometry", "gz.msgs.Odometry", "GZ_TO_ROS"),
        ("/poses", "/world/room/pose/info", "geometry_msgs/msg/PoseArray", "gz.msgs.Pose_V", "GZ_TO_ROS"),
        ("/imu", "/imu", "sensor_msgs/msg/Imu", "gz.msgs.IMU", "GZ_TO_ROS"),
        ("/faint", "/faint", "sensor_msgs/msg/FluidPressure", "gz.msgs.FluidPressure", "GZ_TO_ROS"),
    )
    from gz_course.sim.gz.msgs.fluid_pressure_pb2 import FluidPressure
    from gz_course.sim.gz.msgs.twist_pb2 import Twist

    gz = broken.gz_node()
    gz.advertise("/faint", FluidPressure)
    command = Twist()
    command.linear.x = 0.2
    gz.advertise("/model/robot/cmd_vel", Twist).publish(command)

    node = broken.node("stamper")
    wall, own = (node.create_publisher(Range, topic, 10) for topic in ("/wall", "/own"))
    bare = node.create_publisher(Range, "/bare", QoSPresetProfiles.SENSOR_DATA.value)  # best effort
    scan, framed = node.create_publisher(LaserScan, "/front", 10), node.create_publisher(Imu, "/good_imu", 10)

    def publish():
        message = Range()
        message.header.frame_id = "range_link"
        bare.publish(message)
        message.header.stamp = node.get_clock().now().to_msg()
        wall.publish(message)
        now = server.world.sim_time_ns
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(now, 10**9)
        message.header.frame_id = ""
        own.publish(message)
        beams = LaserScan()
        beams.header.frame_id, beams.header.stamp = "robot/lidar_link/front", message.header.stamp
        scan.publish(beams)
        imu = Imu()
        imu.header.frame_id, imu.header.stamp = "imu_link", message.header.stamp
        imu.orientation_covariance[0] = 0.1
        framed.publish(imu)

    broken.every(node, 0.1, publish)
    broken.node("timed", sim_time=True).create_subscription(Odometry, "/odometry", print, 10)
    moved = threading.Event()
    gz.subscribe(_odometry(), "/model/robot/odometry", lambda message: message.pose.position.x > 0.3 and moved.set())
    assert moved.wait(DEADLINE), "the robot does not drive"
    gz.unsubscribe("/model/robot/odometry")


def _odometry():
    from gz_course.sim.gz.msgs.odometry_pb2 import Odometry

    return Odometry


def told_of(told, kind):
    return [finding.sentence for finding in told.of(kind)]


def test_a_robot_that_drives_on(driving):
    (sentence,) = told_of(driving, "keeps_driving")
    assert sentence.startswith("robot drives on at 0.20 m/s and 0.0")
    assert sentence.endswith("DiffDrive keeps the last command for ever.")


def test_stamps_of_the_wall_clock(driving):
    said = told_of(driving, "stamps")
    assert any(each.startswith("Messages on /wall from /stamper are stamped 1") for each in said)
    assert driving.of("stamps")[-1].evidence == ("/stamper: use_sim_time is false",)
    assert any("use_sim_time:=true" in finding.fix for finding in driving.of("stamps"))


def test_stamps_that_were_never_set(driving):
    assert "Messages on /bare from /stamper have no stamp." in told_of(driving, "stamps")
    assert len(driving.of("stamps")) == 2, "no other topic is stamped badly"


def test_messages_without_a_frame(driving):
    found = {finding.sentence: finding.fix for finding in driving.of("empty_frames")}
    assert "Messages on /own (sensor_msgs/msg/Range) have an empty header.frame_id." in found
    scene = found["Messages on /poses (geometry_msgs/msg/PoseArray) have an empty header.frame_id."]
    assert scene.startswith("Gazebo's pose/info has no frames")
    assert len(found) == 2


def test_a_default_name_as_frame(driving):
    assert told_of(driving, "unknown_frame") == [
        "Messages on /front are in the frame robot/lidar_link/front, Gazebo's default name, which no robot description "
        "has."
    ]
    assert "<gz_frame_id>" in driving.fix("unknown_frame")


def test_covariances_of_zero(driving):
    said = told_of(driving, "zero_covariance")
    assert (
        "Messages on /odom (nav_msgs/msg/Odometry) have covariances that are all zero: pose.covariance and "
        "twist.covariance." in said
    )
    assert not any("/good_imu" in each for each in said)


def test_yaw_from_the_first_pose(driving):
    (sentence,) = told_of(driving, "imu_yaw")
    assert sentence.startswith("The IMU robot/") and "measures its orientation from its first pose" in sentence


def test_a_topic_on_which_nothing_comes(driving):
    assert told_of(driving, "silent_topic") == [
        "Gazebo publishes /faint and /ros_gz_bridge bridges it, but nothing came on /faint in 1 s."
    ]


def test_a_topic_that_is_bridged_under_another_name(driving):
    assert told_of(driving, "not_bridged") == []
    found = {finding.sentence: finding.fix for finding in driving.of("nobody_publishes")}
    sentence = "/timed listens on /odometry (nav_msgs/msg/Odometry), but nobody publishes it."
    assert found == {sentence: "Did you mean /odom? Correct the name or remap it."}


def test_what_is_well_is_not_complained_about(driving):
    kinds = {finding.kind for finding in driving.findings}
    assert not kinds & {"type_clash", "gz_type_clash", "wrong_direction", "no_clock", "paused_world", "missing_system"}
    assert not kinds & {"no_create_service", "two_worlds", "two_clocks", "clock_goes_back", "clock_rate", "no_answer"}


def test_a_paused_world_and_an_old_one(broken):
    broken.world(paused=True)
    broken.world(inside="", name="old")
    broken.bridge(CLOCK)
    broken.bridge(CLOCK, name="ros_gz_bridge_2")
    told = broken.diagnose()
    assert told.sentence("paused_world").startswith("The world room is paused at 0.000 s: no sensor measures")
    assert "--req 'pause: false'" in told.fix("paused_world")
    assert told.sentence("two_worlds").startswith("2 worlds old and room run in the Gazebo partition 'test-")
    assert told.sentence("two_clocks") == (
        "/clock has 2 publishers (/ros_gz_bridge and /ros_gz_bridge_2): time jumps between them."
    )


def test_a_clock_bridged_both_ways(broken):
    broken.bridge((*CLOCK[:4], "BIDIRECTIONAL"))
    told = broken.diagnose(0.1)
    assert told.sentence("clock_loop").startswith("The bridge /ros_gz_bridge publishes the clock /clock in Gazebo, too")


def test_one_world_served_twice(broken):
    for _ in range(2):
        broken.world(inside="")
    assert broken.diagnose(0.2).sentence("two_worlds").startswith("2 simulators of the world room run in")


def test_a_clock_that_is_advertised_and_silent(broken):
    broken.bridge(CLOCK)
    broken.node("waiting", sim_time=True)
    broken.gz_node().advertise("/clock", _clock())
    told = broken.diagnose(0.3)
    assert told.sentence("no_clock") == (
        "/waiting has use_sim_time, but /clock is silent though /ros_gz_bridge publishes it: timers do not fire."
    )


def _clock():
    from gz_course.sim.gz.msgs.clock_pb2 import Clock

    return Clock


def test_a_world_slower_than_the_wall_clock(broken):
    broken.world(inside="", factor=0.25)
    told = broken.diagnose(1.5)
    factor = float(told.sentence("real_time_factor").split("runs at ")[1].split()[0])
    assert 0.0 < factor < 0.3
    assert not told.diagnosis.wrong


def test_a_camera_without_an_optical_frame(broken):
    camera = "<sensor name='eye' type='camera'><topic>eye</topic><update_rate>5</update_rate><camera/></sensor>"
    broken.world(inside=f"<model name='post'><static>true</static><link name='top'>{camera}</link></model>")
    broken.bridge(("/eye", "/eye", "sensor_msgs/msg/Image", "gz.msgs.Image", "GZ_TO_ROS"))
    told = broken.diagnose()
    assert told.sentence("optical_frame") == (
        "The camera post/top/eye has no optical frame, but /eye carries its images to ROS, which takes z as forward."
    )
    assert told.sentence("unknown_frame").startswith("Messages on /eye are in the frame post/top/eye, Gazebo's default")
    assert told.diagnosis.system.ros.heard["/eye"].count == 1, "a camera is left after one image"


def test_a_bridge_that_hangs(broken):
    from std_msgs.msg import Bool

    broken.node("ros_gz_bridge", spins=False).create_publisher(Bool, "/alarm", 10)
    broken.node("listener").create_subscription(Bool, "/alarm", print, 10)
    told = broken.diagnose(0.1)
    assert told.sentence("no_answer").startswith("The bridge /ros_gz_bridge does not answer: ")
    assert told.diagnosis.system.ros.bridges[0].entries[0].ros_topic == "/alarm"


def test_a_bridge_of_another_make_is_read_from_its_file_or_guessed(broken, tmp_path):
    from std_msgs.msg import Bool

    file = tmp_path / "bridge.yaml"
    file.write_text(
        "- {ros_topic_name: /in, gz_topic_name: /gz_in, ros_type_name: std_msgs/msg/Bool, "
        "gz_type_name: gz.msgs.Boolean, direction: ROS_TO_GZ}\n"
    )
    node = broken.node("ros_gz_bridge")
    node.declare_parameter("config_file", str(file))
    broken.node("ros_gz_bridge_2").create_subscription(Bool, "/guessed", print, 10)
    bridges = broken.diagnose(0.1).diagnosis.system.ros.bridges
    told = {bridge.node: [(e.ros_topic, e.gz_topic, e.direction.name) for e in bridge.entries] for bridge in bridges}
    assert told["/ros_gz_bridge"] == [("/in", "/gz_in", "ROS_TO_GZ")]
    assert told["/ros_gz_bridge_2"] == [("/guessed", "/guessed", "ROS_TO_GZ")]
