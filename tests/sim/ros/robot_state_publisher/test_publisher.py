"""StatePublisher between joint states and transforms, which are intercepted before they are sent."""

import math

import pytest

URDF = (
    "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
    "<joint name='turn' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>"
    "<joint name='stiff' type='fixed'><parent link='b'/><child link='c'/><origin xyz='1 2 3'/></joint></robot>"
)


@pytest.fixture
def publisher(ros_node):
    """Return a publisher with these values and the defaults; it appends to the lists `sent` and `static`."""
    from gz_course.sim.ros.robot_state_publisher.publisher import DEFAULTS, StatePublisher

    def make(**values):
        sent, static = [], []
        values = DEFAULTS | {"robot_description": URDF} | values
        for name, value in values.items():
            ros_node.declare_parameter(name, value)
        made = StatePublisher(ros_node, values, sent.append, static.append)
        made.sent, made.static = sent, static
        return made

    return make


def state(seconds, names=("turn",), positions=(1.0,)):
    from sensor_msgs.msg import JointState

    message = JointState(name=list(names), position=list(positions))
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(seconds * 1e9), 10**9)
    return message


def test_frames_stamp_and_numbers(publisher):
    made = publisher(frame_prefix="one/")
    made.take(state(5.25, positions=[math.pi / 2]))
    ((moving,),) = made.sent
    assert (moving.header.frame_id, moving.child_frame_id) == ("one/a", "one/b")
    assert (moving.header.stamp.sec, moving.header.stamp.nanosec) == (5, 250_000_000)
    turn = moving.transform.rotation
    assert (turn.w, turn.x, turn.y, turn.z) == pytest.approx((math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
    ((fixed,),) = made.static
    assert (fixed.header.frame_id, fixed.child_frame_id) == ("one/b", "one/c")
    place = fixed.transform.translation
    assert (place.x, place.y, place.z) == (1.0, 2.0, 3.0)


def test_publish_frequency_counts_the_time_of_the_stamps(publisher):
    made = publisher(publish_frequency=10.0)
    for tick in range(100):
        made.take(state(tick / 100))
    assert len(made.sent) == 10


def test_ignore_timestamp(publisher):
    made = publisher(ignore_timestamp=True)
    for _ in range(5):
        made.take(state(1.0))
    assert len(made.sent) == 5


def test_a_source_that_starts_anew_is_heard(publisher):
    made = publisher()
    made.take(state(100.0))
    made.take(state(0.0))
    assert len(made.sent) == 2


@pytest.mark.parametrize("positions", [[], [1.0, 2.0], [math.nan], [math.inf]])
def test_a_joint_state_that_makes_no_sense_is_passed_over(publisher, positions):
    made = publisher()
    made.take(state(1.0, positions=positions))
    assert made.sent == []


def test_a_new_description_is_published(publisher, ros_node, spin_until):
    from rclpy.parameter import Parameter
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    made = publisher()
    result = ros_node.set_parameters([Parameter("robot_description", value="<robot/>")])[0]
    assert (result.successful, "needs a name" in result.reason) == (False, True)
    result = ros_node.set_parameters([Parameter("frame_prefix", value="x")])[0]
    assert not result.successful
    text = URDF.replace("1 2 3", "7 0 0")
    assert ros_node.set_parameters([Parameter("robot_description", value=text)])[0].successful
    assert made.static[-1][0].transform.translation.x == 7.0
    heard = []
    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    ros_node.create_subscription(String, "robot_description", heard.append, profile)
    spin_until(lambda: heard, "the description")
    assert heard[0].data == text


def test_joint_states_are_heard(publisher, ros_node, spin_until):
    from sensor_msgs.msg import JointState

    made = publisher()
    joint_states = ros_node.create_publisher(JointState, "joint_states", 10)
    seconds = iter(range(1, 10_000))
    spin_until(lambda: joint_states.publish(state(next(seconds))) or made.sent, "a transform")


@pytest.mark.parametrize("frequency", [-1.0, 1001.0, math.nan])
def test_a_frequency_that_makes_no_sense(publisher, frequency):
    from gz_course.sim.ros.ros_program.errors import UsageError

    with pytest.raises(UsageError, match="publish_frequency must be 0 to 1000 Hz"):
        publisher(publish_frequency=frequency)
