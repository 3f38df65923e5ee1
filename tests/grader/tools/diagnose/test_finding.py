"""Order of findings, symptoms that are left out, the rules of single looks, and what they read."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.registry import in_order, module_names, modules
from gz_course.grader.tools.diagnose import finding as findings_module
from gz_course.grader.tools.diagnose import looks
from gz_course.grader.tools.diagnose.finding import Finding, Severity, findings
from gz_course.grader.tools.diagnose.system import (
    GzSide,
    Heard,
    HeardMessage,
    RosEndpoint,
    RosNode,
    RosSide,
    RunningBridge,
    System,
    names,
    nearest_topic,
    users,
)
from gz_course.grader.tools.diagnose.world_text import DEFAULT_SYSTEMS, WorldText
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction


def test_nothing_is_wrong_with_nothing():
    assert findings(System(RosSide(), GzSide())) == []


def test_every_look_is_tested():
    tests = "".join(path.read_text() for path in Path(__file__).parent.glob("test_*.py"))
    assert len(module_names(looks)) >= 25
    assert [name for name in module_names(looks) if f'"{name}"' not in tests] == []


def test_looks_stand_before_others_that_exist_and_not_before_each_other():
    order = in_order({name: getattr(module, "BEFORE", ()) for name, module in modules(looks).items()})
    assert sorted(order) == module_names(looks)


class Look:
    """A module of looks/ for tests."""

    def __init__(self, before, *found):
        self.BEFORE, self._found = before, found

    def look(self, _):
        yield from self._found


def test_worst_first_then_by_before_and_symptoms_of_a_known_cause_left_out(monkeypatch):
    def made(severity, text, *topics, symptom=False):
        return Finding(severity, text, "", (), frozenset(topics), symptom)

    planted = {
        "a": Look((), made(Severity.NOTE, "note"), made(Severity.ERROR, "late", "/a")),
        "b": Look(
            ("c",), made(Severity.ERROR, "of a", "/a", symptom=True), made(Severity.ERROR, "of b", "/b", symptom=True)
        ),
        "c": Look(("a",), made(Severity.WARNING, "warning"), made(Severity.ERROR, "none", symptom=True)),
    }
    monkeypatch.setattr(findings_module, "modules", lambda _: planted)
    found = findings(System(RosSide(), GzSide()))
    assert [each.sentence for each in found] == ["of b", "none", "late", "warning", "note"]
    assert found[0].kind == "b"


def ends(**kinds):
    """A system of `topic_publisher=type` ends."""
    return [RosEndpoint(f"/{key[:1]}", kind, f"/{key}", key.endswith("p"), None) for key, kind in kinds.items()]


def test_frames_unknown_to_the_transforms():
    from sensor_msgs.msg import Range

    lost, known = Range(), Range()
    lost.header.frame_id, known.header.frame_id = "sonar", "base_link"
    side = RosSide(frames={"odom", "base_link"})
    for topic, message in (("/lost", lost), ("/known", known)):
        side.heard[topic] = Heard(topic, "sensor_msgs/msg/Range", 1, False, [HeardMessage(0.0, None, message)])
    (found,) = (each for each in findings(System(side, GzSide())) if each.kind == "unknown_frame")
    assert found.sentence == "Messages on /lost are in the frame sonar, which /tf does not know."
    assert found.severity is Severity.WARNING


@pytest.mark.parametrize(("direction", "evidence"), [("GZ_TO_ROS", ("bridged from /gz/a",)), ("ROS_TO_GZ", ())])
def test_only_what_a_bridge_brings_to_ros_is_said_to_come_from_it(direction, evidence):
    from sensor_msgs.msg import Range

    kind = "sensor_msgs/msg/Range"
    entry = BridgeEntry("/a", "/gz/a", kind, "gz.msgs.LaserScan", Direction(direction))
    side = RosSide(bridges=[RunningBridge("/ros_gz_bridge", (entry,))])
    side.heard["/a"] = Heard("/a", kind, 1, False, [HeardMessage(0.0, None, Range())])
    (found,) = (each for each in findings(System(side, GzSide())) if each.kind == "empty_frames")
    assert found.evidence == evidence


def test_a_node_without_parameter_services_is_not_called_silent():
    side = RosSide(nodes=[RosNode("/quiet", None), RosNode("/dead", False)])
    said = [each.sentence for each in findings(System(side, GzSide())) if each.kind == "no_answer"]
    assert [each.split()[0] for each in said] == ["/dead"]


@pytest.fixture(scope="module")
def profiles():
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

    def made(reliability, durability, liveliness, deadline, lease):
        return QoSProfile(
            depth=1,
            reliability=ReliabilityPolicy[reliability],
            durability=DurabilityPolicy[durability],
            liveliness=LivelinessPolicy[liveliness],
            deadline=Duration(nanoseconds=deadline),
            liveliness_lease_duration=Duration(nanoseconds=lease),
        )

    return made


POLICIES = st.tuples(
    st.sampled_from(["RELIABLE", "BEST_EFFORT"]),
    st.sampled_from(["VOLATILE", "TRANSIENT_LOCAL"]),
    st.sampled_from(["AUTOMATIC", "MANUAL_BY_TOPIC"]),
    st.sampled_from([0, 10**6, 10**9]),
    st.sampled_from([0, 10**6, 10**9]),
)


@given(offered=POLICIES, wanted=POLICIES)
def test_policies_clash_where_ros_says_so(profiles, offered, wanted):
    from rclpy.qos import QoSCompatibility, qos_check_compatible

    from gz_course.grader.tools.diagnose.looks.qos import clashes

    offer, want = profiles(*offered), profiles(*wanted)
    compatible, _ = qos_check_compatible(offer, want)
    assert bool(clashes(offer, want)) == (compatible == QoSCompatibility.ERROR)


@pytest.mark.parametrize(
    ("name", "known", "near"),
    [
        ("/cmd_vel", ["/model/robot/cmd_vel", "/cmd_val"], "/model/robot/cmd_vel"),
        ("/scan", ["/scam", "/odom"], "/scam"),
        ("/scan", ["/scan", "/odom"], ""),
        ("/scan", [], ""),
    ],
)
def test_the_nearest_topic(name, known, near):
    assert nearest_topic(name, known) == near


def test_names_and_verbs():
    assert (names([]), names(["b"]), names("cab")) == ("nobody", "b", "a, b and c")
    assert users(ends(ap="t"), "publish") == "/ap publishes"
    assert users(ends(ap="t", b="t"), "listen") == "/ap and /b listen"


def test_the_text_of_a_world():
    text = """<sdf version='1.10'><world name='w'>
      <plugin filename='gz-sim-imu-system' name='gz::sim::systems::Imu'/>
      <plugin filename='libgz-sim-user-commands-system.so'/>
      <model name='a'><link name='l'><sensor name='s' type='imu'><imu/></sensor></link>
        <model name='b'><joint name='j'><sensor name='f' type='force_torque'/></joint></model>
        <plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'><topic>go</topic></plugin>
      </model></world></sdf>"""
    world = WorldText.read(text)
    assert world.systems == {"Imu", "UserCommands"}
    assert [(sensor.name, sensor.type) for sensor in world.sensors] == [("a/l/s", "imu"), ("a/b/j/f", "force_torque")]
    (drive,) = world.drives
    assert (drive.model, drive.command_topic, drive.odometry_topic) == ("a", "/go", "/model/a/odometry")
    assert WorldText.read("<sdf><world name='w'/></sdf>").systems == DEFAULT_SYSTEMS


@given(text=st.text(max_size=60) | st.sampled_from(["<sdf/>", "<sdf><world>", "<a:b/>", "<sdf><world/></sdf>"]))
def test_any_text_of_a_world_is_read_or_refused_in_words(text):
    try:
        assert WorldText.read(text).sensors == ()
    except ValueError as error:
        assert "SDF" in str(error)


def test_a_clock_that_is_too_fast_and_goes_back():
    """Of what arrived, and when: how often it really comes in a second of this machine is no matter."""
    side = RosSide(seconds=1.5, clock=[(20.0 + n / 1000, 7 * 10**9 + n % 500 * 10**6) for n in range(1200)])
    said = {each.kind: each.sentence for each in findings(System(side, GzSide()))}
    assert said["clock_goes_back"].startswith("/clock went back from 7.499 s to 7.000 s")
    assert said["clock_rate"] == "/clock comes 1000 times a second, which keeps every Python node busy."
    side.clock = [(arrived, n * 10**7) for n, (arrived, _) in enumerate(side.clock[::4])]
    assert not {each.kind for each in findings(System(side, GzSide()))} & {"clock_goes_back", "clock_rate"}
