"""Pairs and services of the packages whose interfaces are made at run time: all are there; what conversions compute."""

import math
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.header import header_value, set_header_value
from gz_course.sim.bridge.ros_gz_bridge.remarks import converted
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError, UnknownPairError, find_pair, find_service
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

PAIRS = [
    ("actuator_msgs/msg/Actuators", "Actuators"),
    ("gps_msgs/msg/GPSFix", "NavSat"),
    ("marine_acoustic_msgs/msg/Dvl", "DVLVelocityTracking"),
    ("ros_gz_interfaces/msg/Altimeter", "Altimeter"),
    ("ros_gz_interfaces/msg/Contact", "Contact"),
    ("ros_gz_interfaces/msg/Contacts", "Contacts"),
    ("ros_gz_interfaces/msg/Dataframe", "Dataframe"),
    ("ros_gz_interfaces/msg/Entity", "Entity"),
    ("ros_gz_interfaces/msg/EntityWrench", "EntityWrench"),
    ("ros_gz_interfaces/msg/Float32Array", "Float_V"),
    ("ros_gz_interfaces/msg/GuiCamera", "GUICamera"),
    ("ros_gz_interfaces/msg/JointWrench", "JointWrench"),
    ("ros_gz_interfaces/msg/Light", "Light"),
    ("ros_gz_interfaces/msg/LogicalCameraImage", "LogicalCameraImage"),
    ("ros_gz_interfaces/msg/MaterialColor", "MaterialColor"),
    ("ros_gz_interfaces/msg/ParamVec", "Param"),
    ("ros_gz_interfaces/msg/ParamVec", "Param_V"),
    ("ros_gz_interfaces/msg/SensorNoise", "SensorNoise"),
    ("ros_gz_interfaces/msg/StringVec", "StringMsg_V"),
    ("ros_gz_interfaces/msg/TrackVisual", "TrackVisual"),
    ("ros_gz_interfaces/msg/VideoRecord", "VideoRecord"),
    ("tf2_msgs/msg/TFMessage", "Pose_V"),
    ("vision_msgs/msg/Detection2D", "AnnotatedAxisAligned2DBox"),
    ("vision_msgs/msg/Detection2DArray", "AnnotatedAxisAligned2DBox_V"),
    ("vision_msgs/msg/Detection3D", "AnnotatedOriented3DBox"),
    ("vision_msgs/msg/Detection3DArray", "AnnotatedOriented3DBox_V"),
]
SERVICES = [
    ("ros_gz_interfaces/srv/ControlWorld", "gz.msgs.WorldControl"),
    ("ros_gz_interfaces/srv/DeleteEntity", "gz.msgs.Entity"),
    ("ros_gz_interfaces/srv/SetEntityPose", "gz.msgs.Pose"),
    ("ros_gz_interfaces/srv/SpawnEntity", "gz.msgs.EntityFactory"),
]


@pytest.fixture
def pair_of():
    return lambda ros_type, gz_name: find_pair(ros_type, f"gz.msgs.{gz_name}")


def test_all_pairs_and_services_appear_with_their_packages():
    found = {(pair.ros_type, pair.gz_type) for pair in type_pairs.pairs()}
    packages = {ros_type.split("/")[0] for ros_type, _ in PAIRS}
    assert {key for key in found if key[0].split("/")[0] in packages} == {(r, f"gz.msgs.{g}") for r, g in PAIRS}
    assert len(found) == 69
    assert [(s.ros_type, s.gz_request_type) for s in type_pairs.services()] == SERVICES
    assert {service.gz_reply_type for service in type_pairs.services()} == {"gz.msgs.Boolean"}
    assert type_pairs.missing_packages() == []


def test_both_collisions_of_a_contact_arrive(pair_of):
    pair = pair_of("ros_gz_interfaces/msg/Contact", "Contact")
    ros = pair.ros_class()
    ros.collision1.name, ros.collision2.name = "wheel", "ground"
    gz = pair.to_gz(ros)
    assert (gz.collision1.name, gz.collision2.name) == ("wheel", "ground")
    assert pair.to_ros(gz).collision2.name == "ground"


def test_every_transform_has_the_frames_of_its_own_pose(pair_of):
    gz = Pose_V()
    for parent, child in (("odom", "robot::base"), ("robot::base", "lidar")):
        pose = gz.pose.add()
        set_header_value(pose.header, "frame_id", parent)
        set_header_value(pose.header, "child_frame_id", child)
    gz.pose.add(name="no header")
    gz.pose[0].header.stamp.sec = 7
    pair = pair_of("tf2_msgs/msg/TFMessage", "Pose_V")
    ros = pair.to_ros(gz)
    frames = [(one.header.frame_id, one.child_frame_id) for one in ros.transforms]
    assert frames == [("odom", "robot/base"), ("robot/base", "lidar"), ("", "")]
    back = pair.to_gz(ros)
    assert (back.header.stamp.sec, header_value(back.header, "frame_id")) == (7, "odom"), "the header of the first"
    assert not pair.to_gz(pair.ros_class()).HasField("header")


def test_the_speed_of_a_fix_has_a_length_and_a_direction(pair_of):
    pair = pair_of("gps_msgs/msg/GPSFix", "NavSat")
    gz = pair.gz_class(latitude_deg=1.0, longitude_deg=2.0, altitude=3.0, frame_id="a::gps")
    gz.velocity_east, gz.velocity_north, gz.velocity_up = 3.0, 4.0, -1.0
    ros = pair.to_ros(gz)
    assert (ros.latitude, ros.longitude, ros.altitude, ros.header.frame_id) == (1.0, 2.0, 3.0, "a/gps")
    assert (ros.speed, ros.track, ros.climb) == (5.0, math.atan2(4.0, 3.0), -1.0)
    back = pair.to_gz(ros)
    assert (back.velocity_east, back.velocity_north, back.velocity_up) == pytest.approx((3.0, 4.0, -1.0))
    assert pair.to_gz(pair.ros_class(track=math.nan, speed=2.0)).velocity_east == 2.0


def test_a_doppler_log_reports_the_beams_with_a_lock(pair_of):
    pair = pair_of("marine_acoustic_msgs/msg/Dvl", "DVLVelocityTracking")
    gz = pair.gz_class(type="DVL_TYPE_PHASED_ARRAY")
    gz.target.type = 2
    gz.velocity.mean.x, gz.velocity.mean.y = 3.0, 4.0
    for number in range(6):
        beam = gz.beams.add(id=number, locked=number != 1)
        beam.range.mean = number * 10.0
        beam.velocity.mean.z = -2.0
    ros = pair.to_ros(gz)
    assert (ros.velocity_mode, ros.dvl_type, ros.speed_gnd, ros.num_good_beams) == (2, 1, 5.0, 4)
    assert (list(ros.range), list(ros.beam_velocity)) == ([0.0, 20.0, 30.0, 40.0], [2.0] * 4)
    assert list(ros.velocity_covar) == [-1.0] * 9
    ros.beam_unit_vec[0].z = -1.0
    back = pair.to_gz(ros)
    assert (len(back.beams), back.beams[0].velocity.mean.z, back.type, back.target.type) == (4, -2.0, 2, 2)
    assert pair.to_ros(pair.gz_class()).beam_ranges_valid is False
    ros.num_good_beams = 200
    assert len(pair.to_gz(ros).beams) == 4


def test_boxes_have_corners_in_gazebo_and_a_centre_in_ros(pair_of):
    pair = pair_of("vision_msgs/msg/Detection2DArray", "AnnotatedAxisAligned2DBox_V")
    gz = pair.gz_class()
    one = gz.annotated_box.add(label=65)
    one.box.min_corner.x, one.box.min_corner.y, one.box.max_corner.x, one.box.max_corner.y = 10, 20, 30, 60
    found = pair.to_ros(gz).detections[0]
    assert (found.bbox.center.position.x, found.bbox.center.position.y) == (20.0, 40.0)
    assert (found.bbox.size_x, found.bbox.size_y) == (20.0, 40.0)
    assert [(r.hypothesis.class_id, r.hypothesis.score) for r in found.results] == [("65", 1.0)]
    back = pair.to_gz(pair.to_ros(gz)).annotated_box[0]
    assert (back.label, back.box.min_corner.y, back.box.max_corner.x) == (65, 20.0, 30.0)
    found.bbox.center.theta = 0.1
    single = pair_of("vision_msgs/msg/Detection2D", "AnnotatedAxisAligned2DBox")
    with pytest.raises(ConversionError, match=r"turned by 0\.1 rad"):
        single.to_gz(found)


def test_boxes_in_space_keep_their_orientation_and_label(pair_of):
    pair = pair_of("vision_msgs/msg/Detection3DArray", "AnnotatedOriented3DBox_V")
    gz = pair.gz_class()
    one = gz.annotated_box.add(label=7)
    one.box.center.x, one.box.orientation.z, one.box.boxSize.y = 1.0, -1.0, 2.0
    back = pair.to_gz(pair.to_ros(gz)).annotated_box[0]
    assert (back.box.center.x, back.box.orientation.z, back.box.boxSize.y, back.label) == (1.0, -1.0, 2.0, 7)


@pytest.mark.parametrize("text", ["person", "", "-1", "4294967296", "²", "9" * 5000])
def test_a_class_that_is_no_label_is_refused(pair_of, text):
    pair = pair_of("vision_msgs/msg/Detection3D", "AnnotatedOriented3DBox")
    ros = pair.to_ros(pair.gz_class(label=3))
    ros.results[0].hypothesis.class_id = text
    with pytest.raises(ConversionError, match="is not a label of Gazebo"):
        pair.to_gz(ros)
    ros.results = []
    assert pair.to_gz(ros).label == 0


_NAMES = st.text(st.characters(categories=["Ll", "Nd"]), min_size=1, max_size=5)
_TREES = st.recursive(
    st.tuples(st.dictionaries(_NAMES, st.integers(-(2**31), 2**31 - 1), min_size=1, max_size=3), st.just([])),
    lambda inner: st.tuples(
        st.dictionaries(_NAMES, st.integers(-(2**31), 2**31 - 1), max_size=3), st.lists(inner, min_size=1, max_size=3)
    ),
    max_leaves=8,
)


def fill(param, tree):
    for name, value in tree[0].items():
        param.params[name].type = 2
        param.params[name].int_value = value
    for child in tree[1]:
        fill(param.children.add(), child)


@pytest.mark.hypothesis
def test_nested_parameters_find_their_way_back(pair_of):
    one, several = (pair_of("ros_gz_interfaces/msg/ParamVec", name) for name in ("Param", "Param_V"))

    @settings(max_examples=60)
    @given(st.lists(_TREES, max_size=3))
    def check(trees):
        gz = several.gz_class()
        for tree in trees:
            fill(gz.param.add(), tree)
            assert one.to_gz(one.to_ros(gz.param[-1])).params == gz.param[-1].params
            assert one.to_gz(one.to_ros(gz.param[-1])).children == gz.param[-1].children
        assert several.to_gz(several.to_ros(gz)).param == gz.param

    check()


def test_nested_parameters_are_named_after_their_place(pair_of):
    pair = pair_of("ros_gz_interfaces/msg/ParamVec", "Param_V")
    gz = pair.gz_class()
    fill(gz.param.add(), ({"a": 1}, []))
    fill(gz.param.add(), ({}, [({"b": 2}, [({"c": 3}, [])])]))
    gz.param[0].params["pose"].type = 7
    values = {param.name: (param.value.type, param.value.integer_value) for param in pair.to_ros(gz).params}
    assert values == {
        "param_0/a": (2, 1),
        "param_0/pose": (0, 0),
        "param_1/child_0/b": (2, 2),
        "param_1/child_0/child_0/c": (2, 3),
    }


def test_hostile_names_of_parameters_cost_nothing(pair_of):
    from rcl_interfaces.msg import Parameter, ParameterValue

    pair = pair_of("ros_gz_interfaces/msg/ParamVec", "Param")
    ros = pair.ros_class(params=[Parameter(name="child_999999999/x", value=ParameterValue(type=2, integer_value=1))])
    assert len(pair.to_gz(ros).children) == 1
    ros.params[0].name = "child_0/" * 1000 + "x"
    with pytest.raises(ConversionError, match="nested deeper than 50 times"):
        pair.to_gz(ros)
    ros.params = [Parameter(name="list", value=ParameterValue(type=9))]
    gz, (text,) = converted(pair.to_gz, ros)
    assert (gz.params["list"].type, "the parameter list is a list" in text) == (0, True)


def test_a_wrench_and_actuators_that_are_not_finite_are_named(pair_of):
    wrench = pair_of("ros_gz_interfaces/msg/EntityWrench", "EntityWrench")
    ros = wrench.ros_class()
    assert wrench.fault(ros) is None
    ros.wrench.force.y = math.inf
    assert wrench.fault(ros) == "wrench.force.y is inf"
    actuators = pair_of("actuator_msgs/msg/Actuators", "Actuators")
    assert actuators.fault(actuators.ros_class(velocity=[0.0, 1.0])) is None
    assert actuators.fault(actuators.ros_class(velocity=[0.0, math.nan])) == "velocity[1] is nan"


def test_a_number_that_does_not_fit_an_enumeration_is_refused(pair_of):
    pair = pair_of("ros_gz_interfaces/msg/Entity", "Entity")
    with pytest.raises(ConversionError, match="the number 300 does not fit"):
        pair.to_ros(pair.gz_class(type=300))


def test_control_of_the_world_sets_every_field():
    service = find_service("ros_gz_interfaces/srv/ControlWorld")
    ros = service.ros_class.Request()
    ros.world_control.reset.all, ros.world_control.multi_step = True, 5
    gz = service.request_to_gz(ros)
    assert (gz.pause, gz.multi_step, gz.reset.all, gz.HasField("run_to_sim_time")) == (False, 5, True, True)
    assert type(gz) is service.gz_request_class
    assert service.reply_to_ros(service.gz_reply_class(data=True)).success is True
    assert service.reply_to_ros(service.gz_reply_class()).success is False


def test_an_entity_is_spawned_from_the_first_source_given():
    service = find_service("ros_gz_interfaces/srv/SpawnEntity", "gz.msgs.EntityFactory", "gz.msgs.Boolean")
    ros = service.ros_class.Request()
    with pytest.raises(ConversionError, match="nothing to spawn: none of sdf, sdf_filename, clone_name"):
        service.request_to_gz(ros)
    ros.entity_factory.clone_name, ros.entity_factory.sdf_filename = "other", "box.sdf"
    ros.entity_factory.name, ros.entity_factory.allow_renaming, ros.entity_factory.pose.position.z = "box", True, 2.0
    gz = service.request_to_gz(ros)
    assert (gz.WhichOneof("from"), gz.sdf_filename, gz.name, gz.allow_renaming) == (
        "sdf_filename",
        "box.sdf",
        "box",
        True,
    )
    assert (gz.pose.position.z, gz.pose.orientation.w, gz.relative_to) == (2.0, 1.0, "world")
    assert service.fault(ros) is None
    ros.entity_factory.pose.orientation.w = math.nan
    assert service.fault(ros) == "entity_factory.pose.orientation.w is nan"


def test_entities_are_deleted_and_moved_by_name_or_id():
    delete, move = (find_service(f"ros_gz_interfaces/srv/{name}") for name in ("DeleteEntity", "SetEntityPose"))
    request = delete.ros_class.Request()
    request.entity.name, request.entity.type, request.entity.id = "box", 2, 2**40
    gz = delete.request_to_gz(request)
    assert (gz.name, gz.type, gz.id) == ("box", 2, 2**40)
    request = move.ros_class.Request()
    request.entity.name, request.entity.id, request.pose.position.x = "box", 8, 1.5
    gz = move.request_to_gz(request)
    assert (gz.name, gz.id, gz.position.x, gz.orientation.w) == ("box", 8, 1.5, 1.0)
    request.entity.id = 2**32
    with pytest.raises(ConversionError, match="does not fit the 32 bits"):
        move.request_to_gz(request)


def test_a_service_of_other_types_is_refused_with_the_right_ones():
    with pytest.raises(UnknownPairError, match=re.escape("it takes gz.msgs.Pose and answers gz.msgs.Boolean")):
        find_service("ros_gz_interfaces/srv/SetEntityPose", "gz.msgs.Entity", "gz.msgs.Boolean")
    with pytest.raises(UnknownPairError, match="the nearest is ros_gz_interfaces/srv/SpawnEntity"):
        find_service("ros_gz_interfaces/srv/SpawnEntities")
