"""Faults of a robot that its parts prove: each is named, and a good robot has none of them."""

import json

import numpy as np
import pytest

from gz_course.grader.feedback.predictions.of_robots import driving, scanning, standing, topics
from gz_course.grader.feedback.predictions.of_robots.creating import at_work_on, description_meaning, misplaced, overlap
from gz_course.grader.kinds.launch.robot_facts import MOST_PARTS, robot_facts
from gz_course.grader.score.graphs import Bridged
from gz_course.grader.score.robots import robot_of
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.reader import read_model

INERTIAL = "<inertial><mass value='{}'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>"
WHEEL = """
<link name="{0}_wheel">{2}<collision><geometry><cylinder radius="0.06" length="0.03"/></geometry></collision></link>
<joint name="{0}_joint" type="continuous"><parent link="base"/><child link="{0}_wheel"/>
  <origin xyz="0 {1} 0.06" rpy="-1.570796 0 0"/><axis xyz="0 0 1"/></joint>"""
ROBOT = f"""<robot name="scout">
<link name="base">{INERTIAL.format(4).replace("<mass", "<origin xyz='-0.04 0 0.08'/><mass")}
  <collision><origin xyz="-0.04 0 0.09"/><geometry><box size="0.34 0.2 0.1"/></geometry></collision></link>
{WHEEL.format("left", 0.15, INERTIAL.format(0.4))}{WHEEL.format("right", -0.15, INERTIAL.format(0.4))}
<link name="caster">{INERTIAL.format(0.2)}
  <collision><geometry><sphere radius="0.03"/></geometry></collision></link>
<joint name="caster_joint" type="fixed"><parent link="base"/><child link="caster"/>
  <origin xyz="-0.16 0 0.03"/></joint>
<gazebo reference="caster"><mu1>0</mu1><mu2>0</mu2></gazebo>
<link name="lidar_link">{INERTIAL.format(0.1)}</link>
<joint name="lidar_joint" type="fixed"><parent link="base"/><child link="lidar_link"/><origin xyz="0 0 0.2"/></joint>
<gazebo reference="lidar_link"><sensor name="lidar" type="gpu_lidar"><topic>/model/scout/scan</topic>
  <gz_frame_id>lidar_link</gz_frame_id><update_rate>10</update_rate><lidar><scan><horizontal><samples>360</samples>
  <min_angle>-3.14159</min_angle><max_angle>3.14159</max_angle></horizontal></scan>
  <range><min>0.1</min><max>12</max></range></lidar></sensor></gazebo>
<gazebo>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>left_joint</left_joint>
  <right_joint>right_joint</right_joint><wheel_separation>0.3</wheel_separation><wheel_radius>0.06</wheel_radius></plugin>
<plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher">
  <topic>joints</topic>
</plugin></gazebo></robot>"""


@pytest.fixture
def built(record):
    """`built(("0.06", "0.05"), ...)`: the robot with these texts replaced, read back from a recording."""

    def build(*changes):
        text = ROBOT
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        facts = robot_facts(read_model(text, "robot.urdf", Diagnostics(quiet=True), "scout"))
        json.dumps(facts, allow_nan=False)
        return robot_of(record({}, facts={"launch": {"robots": {"scout": facts}}}), "scout")

    return build


# Every explanation, as it is asked for a robot that was told to drive at 0.4 m/s and turn at 0.8 rad/s.
LOOKS = {
    "stuck": driving.does_not_drive,
    "slow": lambda robot: driving.other_speed(robot, 0.4, 0.5),
    "curve": driving.unequal_wheels,
    "turns": lambda robot: driving.turns_slowly(robot, 0.8),
    "sides": driving.sides_exchanged,
    "middle": driving.beside_the_middle,
    "leans": driving.leans,
    "falls": standing.falls_over,
    "tips": standing.tips_over,
    "through": standing.without_collisions,
    "above": lambda robot: standing.above_the_ground(robot, 0.0),
    "in": lambda robot: standing.in_the_ground(robot, 0.0),
    "narrow": lambda robot: scanning.narrow(robot, 6.2).replace("<samples> of the lidar is 360", ""),
    "slow scans": lambda robot: scanning.few_scans(robot, 5.0),
    "classic": scanning.of_gazebo_classic,
    "tilted": scanning.tilted,
    "enclosed": scanning.enclosed,
}


def test_a_good_robot_has_none_of_these_faults(built):
    robot = built()
    assert {name: said for name, look in LOOKS.items() if (said := look(robot))} == {}


AXIS = '<axis xyz="0 0 1"/>'
PLUGIN = "<wheel_radius>0.06</wheel_radius>"
ROLL = "-1.570796 0 0"


@pytest.mark.parametrize(
    ("look", "changes", "words"),
    [
        ("stuck", [("DiffDrive", "Other")], "has no gz::sim::systems::DiffDrive, it has gz::sim::systems::Other"),
        ("stuck", [(AXIS, '<axis xyz="0 1 0"/>')], "left_joint turns about another axis than the axle of its wheel"),
        ("stuck", [(AXIS, "")], "a joint without <axis> turns about x"),
        ("stuck", [(ROLL, "0 0 0")], "the axle of left_wheel points along z"),
        ("stuck", [('<origin xyz="-0.16 0 0.03"/>', '<origin xyz="-0.16 0 0"/>')], "caster reaches 0.030 m lower"),
        ("stuck", [("<right_joint>right_joint", "<right_joint>left_joint")], "are both left_joint"),
        ("stuck", [('"0 -0.15 0.06"', '"0 0.3 0.06"')], "both wheels are on the same side"),
        ("slow", [(PLUGIN, "<wheel_radius>0.12</wheel_radius>")], "0.12 m, and the cylinder of left_wheel has 0.06 m"),
        ("slow", [(PLUGIN, "")], "0.2 m (its default), and the cylinder"),
        ("slow", [(PLUGIN, PLUGIN + "<max_linear_velocity>0.1</max_linear_velocity>")], "<max_linear_velocity>"),
        ("slow", [(PLUGIN, PLUGIN + "<max_linear_acceleration>0.1</max_linear_acceleration>")], "takes 4.00 s"),
        ("slow", [(AXIS, AXIS + "<limit effort='9' velocity='1'/>")], "rolls at 0.06 m/s"),
        ("slow", [(AXIS, AXIS + "<limit effort='0.01' velocity='99'/>")], "too little to turn the wheel"),
        ("slow", [(AXIS, AXIS + "<dynamics damping='1'/>")], "brakes the wheel"),
        (
            "slow",
            [("<mu1>0</mu1><mu2>0</mu2>", "<mu1>1</mu1><mu2>1</mu2>")],
            "caster (a sphere) slides along the ground",
        ),
        ("slow", [("<mass value='4'", "<mass value='4000'")], "masses are in kg, not in g"),
        (
            "slow",
            [
                ('type="continuous"', 'type="revolute"'),
                (AXIS, AXIS + "<limit lower='-3.14' upper='3.14' effort='9' velocity='99'/>"),
            ],
            "left_joint has the limits -3.14 to 3.14 rad, so the wheel stops there",
        ),
        ("curve", [('"0 -0.15 0.06"', '"0 -0.1 0.06"')], "not equally far from the middle"),
        ("turns", [("<wheel_separation>0.3", "<wheel_separation>0.15")], "0.15 m, and their middles are 0.3 m apart"),
        ("sides", [('"0 0.15 0.06"', '"0 -0.15 0.06"')], "left_joint, which is on the right"),
        ("middle", [('"0 0.15 0.06"', '"0.1 0.15 0.06"'), ('"0 -0.15 0.06"', '"0.1 -0.15 0.06"')], "is at x 0.10 m"),
        ("leans", [(ROLL, "-90 0 0")], "tilted by 27 degrees"),
        ("falls", [('"-0.16 0 0.03"', '"0.16 0 0.03"')], "its centre of mass, at x -0.03 m, is behind"),
        ("falls", [('"-0.16 0 0.03"', '"-0.16 0 0.07"')], "nothing carries it in front or behind"),
        ("falls", [(ROLL, "0 0 0")], "the axle of left_wheel points along z"),
        ("tips", [("xyz='-0.04 0 0.08'", "xyz='-0.01 0 0.5'")], "centre of mass is 0.41 m above the ground"),
        ("tips", [("<mass value='4'", "<mass value='0.1'")], "too little for a body of 0.34 x 0.2 x 0.1 m"),
        ("tips", [("<mass value='4'", "<mass value='1e11'")], "link base has a mass of 1e+11 kg"),
        (
            "above",
            [
                ('"0 0.15 0.06"', '"0 0.15 1.06"'),
                ('"0 -0.15 0.06"', '"0 -0.15 1.06"'),
                ('"-0.16 0 0.03"', '"0 0 1.03"'),
            ],
            "0.04 m above the ground",
        ),
        ("in", [('"-0.16 0 0.03"', '"-0.16 0 -0.1"')], "its lowest part, caster, came 0.13 m below it"),
        (
            "narrow",
            [("<min_angle>-3.14159</min_angle>", "")],
            "from <min_angle> 0 (its default) to <max_angle> 3.14159",
        ),
        ("narrow", [("3.14159", "180")], "-180 and 180 degrees are -3.14159 and 3.14159"),
        ("narrow", [("<samples>360", "<samples>36")], "<samples> of the lidar is 36"),
        ("slow scans", [("<update_rate>10", "<update_rate>1")], "<update_rate> of the lidar is 1 Hz"),
        ("classic", [("gpu_lidar", "ray")], "of type ray, which Gazebo Classic had"),
        ("tilted", [('"0 0 0.2"', '"0 0 0.2" rpy="0 0.3 0"')], "tilted by 17 degrees"),
        ("enclosed", [('"0 0 0.2"', '"0 0 0.09"')], "the lidar is inside of base: a sensor stands at the origin"),
    ],
)
def test_a_fault_is_named(built, look, changes, words):
    assert words in LOOKS[look](built(*changes))


def test_a_robot_that_is_only_partly_known_is_not_judged(built, record):
    facts = {"links": [], "joints": [], "sensors": [], "plugins": [], "complete": False}
    for robots in ({}, {"scout": facts}, {"scout": facts | {"complete": True}}):
        assert robot_of(record({}, facts={"launch": {"robots": robots}}), "scout") is None
    text = "<sdf version='1.9'><model name='m'>" + "".join(f"<link name='l{n}'/>" for n in range(99)) + "</model></sdf>"
    many = robot_facts(read_model(text, "m.sdf", Diagnostics(quiet=True)))
    assert not many["complete"] and len(many["links"]) == MOST_PARTS


def bridged(ros_topic, kind, gz_topic, direction="GZ_TO_ROS"):
    return Bridged("argument 'a'", ros_topic, kind, gz_topic, "", direction, 0, 0, None, None)


TWIST, SCAN = "geometry_msgs/msg/Twist", "sensor_msgs/msg/LaserScan"


def test_names_on_the_two_sides_of_a_bridge(built):
    robot = built()
    good = bridged("/cmd_vel", TWIST, "/model/scout/cmd_vel", "ROS_TO_GZ")
    assert topics.commands_elsewhere(robot, [good], "/cmd_vel") == ""
    assert topics.why_not_carried([good], "/cmd_vel", TWIST, to_gz=True) == ""
    other = bridged("/cmd_vel", TWIST, "/cmd_vel", "ROS_TO_GZ")
    assert "DiffDrive listens to /model/scout/cmd_vel" in topics.commands_elsewhere(robot, [other], "/cmd_vel")
    scan = bridged("/scan", SCAN, "/scan")
    assert "the lidar publishes on /model/scout/scan" in scanning.no_scan(robot, scan)
    assert "no sensor of type gpu_lidar" in scanning.no_scan(built(('type="gpu_lidar"', 'type="imu"')), scan)
    assert topics.no_joint_states(robot, bridged("/joint_states", "", "/joints")) == ""
    assert "publishes on /joints" in topics.no_joint_states(robot, bridged("/joint_states", "", "/model/scout/j"))
    assert "has no plugin" in topics.no_joint_states(built(("JointStateP", "P")), bridged("/joint_states", "", "/j"))
    named = built(("<topic>joints</topic>", "<joint_name>left_joint</joint_name>"))
    assert "names only left_joint" in topics.few_joints(named)
    assert "has no <topic>" in topics.no_joint_states(named, bridged("/joint_states", "", "/j"))


@pytest.mark.parametrize(
    ("made", "said", "words"),
    [
        ([], "", "no bridge has the ROS topic /cmd_vel"),
        ([], f"{TWIST} cannot become gz.msgs.Pose", "the bridge left it out"),
        ([bridged("/cmd_vel", TWIST, "/c")], "", "goes the wrong way, from Gazebo to ROS"),
        ([bridged("/cmd_vel", "a/msg/B", "/c", "ROS_TO_GZ")], "", "/cmd_vel is a/msg/B here"),
        (
            [bridged("/model/m/cmd_vel", TWIST, "/model/m/cmd_vel", "ROS_TO_GZ")],
            "",
            "a remapping to /cmd_vel is missing",
        ),
        ([bridged("/drive", TWIST, "/c", "ROS_TO_GZ")], "", "it is called /drive in ROS, not /cmd_vel"),
    ],
)
def test_why_commands_are_not_carried(made, said, words):
    assert words in topics.why_not_carried(made, "/cmd_vel", TWIST, to_gz=True, said=said)


def test_a_remapping_the_wrong_way_round_is_named_with_its_line():
    made = [bridged("/model/m/cmd_vel", TWIST, "/model/m/cmd_vel", "ROS_TO_GZ")]
    remapped = [{"file": "a.launch.py", "line": 7, "from": "/cmd_vel", "to": "/model/m/cmd_vel"}]
    said = topics.why_not_carried(made, "/cmd_vel", TWIST, to_gz=True, remapped=remapped)
    assert "a.launch.py, line 7, has the two names of the remapping exchanged" in said
    remapped[0] |= {"from": "/model/m/cmd_vel", "to": "/drive"}
    said = topics.why_not_carried(made, "/cmd_vel", TWIST, to_gz=True, remapped=remapped)
    assert "exchanged: the old" not in said


def test_a_robot_with_both_wheels_on_one_side_falls_for_that(built):
    assert "both wheels are on the same side" in standing.falls_over(built(("0 -0.15 0.06", "0 0.15 0.06")))


def test_wheels_that_slip_may_hang_by_less(built):
    low = built(('<origin xyz="-0.16 0 0.03"/>', '<origin xyz="-0.16 0 0.028"/>'))
    assert driving.hangs(low) == ""
    assert "caster reaches 0.002 m lower than the wheels" in driving.hangs(low, 0.001)


NAMES = {"x": "x", "y": "y", "yaw": "yaw"}
WANTED = {"x": -1.5, "y": 0.5, "yaw": 0.4}


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ({"x": 0.5, "y": -1.5}, "the arguments x and y are exchanged"),
        ({"y": -0.5}, "y has the wrong sign"),
        ({"yaw": -0.4}, "yaw has the wrong sign"),
        ({"yaw": np.radians(0.4)}, "converted from degrees to radians"),
        ({"yaw": np.remainder(np.degrees(0.4), 2 * np.pi)}, "converted from radians to degrees"),
        ({"y": 0.4, "yaw": 0.0}, "the value of yaw was taken for y; the argument yaw had no effect"),
        ({"x": 7.0}, ""),
    ],
)
def test_where_a_robot_came_instead(place, words):
    said = misplaced(WANTED, WANTED | place, list(place), NAMES)
    assert words in said and bool(words) == bool(said)


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("the parameter robot_description must be a text, not 0", "the number 0, such as os.system"),
        (
            "<robot_description>:4: <xacro:property> is for xacro, which was not run",
            "the text of the xacro file itself",
        ),
        ("something else", ""),
    ],
)
def test_what_is_wrong_with_a_description(said, words):
    assert words in description_meaning(said) and bool(words) == bool(description_meaning(said))


def test_parts_that_start_inside_each_other():
    caster, mast = (f"scout::base::base_fixed_joint_lump__{name}_collision_1" for name in ("caster", "mast"))
    ground = f"'ground_plane::link::c' and '{caster}' are 0.015 m inside each other"
    own = f"'scout::left_wheel::c' and '{mast}' are 0.02 m inside each other; they are pushed apart"
    assert overlap([ground], "scout") == "" and overlap([own], "robot") == ""
    assert overlap([ground, own], "scout").startswith("left_wheel and mast are 0.02 m inside each other")


def test_a_robot_that_is_too_large_for_create(record):
    asked = (0, "[create-3] [INFO] [ros_gz_sim]: Requesting creation of an entity in world 'yard'")
    large = (0, "[robot_state_publisher-2] [INFO] [r]: Robot initialized: 'scout', 10000 joints move, 0 are fixed")
    small = (0, "[robot_state_publisher-2] [INFO] [r]: Robot initialized: 'scout', 2 joints move, 3 are fixed")
    assert "10000 joints" in at_work_on(record({}, lines=[asked, large]))
    assert not at_work_on(record({}, lines=[asked, small])) and not at_work_on(record({}, lines=[large]))
