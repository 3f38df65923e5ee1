import importlib
import pickle
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

import gz_course.sim.gz.msgs as gz_msgs
from gz_course.sim.gz.msgs import UnknownTypeError, message_class, registry, type_names


def test_every_file_can_be_imported_and_holds_its_types():
    found = set()
    for stem in registry.file_stems():
        module = importlib.import_module(f"gz_course.sim.gz.msgs.{stem}_pb2")
        assert module.DESCRIPTOR.name == f"gz/msgs/{stem}.proto"
        found |= {f"gz.msgs.{name}" for name in module.DESCRIPTOR.message_types_by_name}
        for name in module.DESCRIPTOR.message_types_by_name:
            assert getattr(module, name) is message_class(f"gz.msgs.{name}")
    assert sorted(found) == type_names()
    assert {"gz.msgs.Scene", "gz.msgs.SerializedStepMap", "gz.msgs.PID", "gz.msgs.Marker_V"} <= found


def survives_a_round_trip(name):
    kind = message_class(name)
    message = kind()
    for field in kind.DESCRIPTOR.fields:
        if field.message_type is None and not field.is_repeated:
            default = field.default_value
            setattr(message, field.name, {str: "x", bytes: b"x", bool: True}.get(type(default), 1))
    return kind.DESCRIPTOR.full_name == name and kind.FromString(message.SerializeToString()) == message


def test_every_type_survives_a_round_trip():
    lost = [name for name in type_names() if not survives_a_round_trip(name)]
    assert not lost, "\n".join(lost)


@pytest.mark.parametrize("name", ["gz.msgs.Twist", "gz_msgs.Twist", ".gz.msgs.Twist", "ignition.msgs.Twist", "Twist"])
def test_all_spellings_are_one_class(name):
    from gz_course.sim.gz.msgs.twist_pb2 import Twist

    assert message_class(name) is Twist


def test_nested_types_enums_maps_and_oneofs():
    from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
    from gz_course.sim.gz.msgs.header_pb2 import Header
    from gz_course.sim.gz.msgs.image_pb2 import RGB_INT8, PixelFormatType
    from gz_course.sim.gz.msgs.param_pb2 import Param

    assert message_class("gz.msgs.Header.Map") is Header.Map
    assert PixelFormatType.Name(RGB_INT8) == "RGB_INT8"
    assert RGB_INT8 == 3
    param = Param()
    param.params["speed"].double_value = 0.5
    assert Param.FromString(param.SerializeToString()).params["speed"].double_value == 0.5
    factory = EntityFactory(sdf="<sdf/>")
    factory.sdf_filename = "box.sdf"
    assert factory.WhichOneof("from") == "sdf_filename"
    assert factory.sdf == ""


def test_the_bytes_are_those_of_gazebo():
    from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
    from gz_course.sim.gz.msgs.twist_pb2 import Twist

    twist = Twist()
    twist.linear.x = 1.5
    assert twist.SerializeToString().hex() == "12091100000000000" + "0f83f"
    scan = LaserScan(ranges=[1.0, 2.0])  # repeated numbers are packed: one tag, one length
    assert scan.SerializeToString().hex() == "7210" + "000000000000f03f" + "0000000000000040"
    assert pickle.loads(pickle.dumps(twist)) == twist


def test_fields_that_are_not_described_are_kept():
    from gz_course.sim.gz.msgs.model_pb2 import Model

    data = bytes.fromhex("1203626f78") + bytes.fromhex("a206020801")  # name "box", and field 100
    assert Model.FromString(data).SerializeToString() == data


@pytest.mark.parametrize(
    ("name", "nearest"),
    [("gz.msgs.Twits", "gz.msgs.Twist"), ("gz.msgs.laserscan", "gz.msgs.LaserScan"), ("Header.Mop", "")],
)
def test_an_unknown_type_is_answered_with_the_nearest(name, nearest):
    with pytest.raises(UnknownTypeError) as caught:
        message_class(name)
    assert repr(name) in str(caught.value)
    assert nearest in str(caught.value)


@given(st.text())
def test_any_text_is_a_type_or_an_unknown_type(name):
    try:
        assert message_class(name).DESCRIPTOR.full_name.startswith("gz.msgs.")
    except UnknownTypeError as error:
        assert isinstance(error, ValueError)


def test_a_module_that_does_not_exist_is_an_import_error():
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("gz_course.sim.gz.msgs.twits_pb2")


def test_only_what_is_asked_for_is_built():
    script = (
        "import gz.msgs.twist_pb2, gz.msgs.registry as registry\n"
        "assert registry._loaded == {'twist', 'header', 'time', 'vector3d'}, registry._loaded\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=600)


def test_the_definitions_are_inside_the_package():
    assert registry.PROTO_FOLDER.is_relative_to(gz_msgs.__path__[0])


# Messages that exist only in Harmonic cannot be compared with Debian's Fortress; some field numbers are checked here.
@pytest.mark.parametrize(
    ("name", "fields"),
    [
        ("CameraTrack", {"track_mode": 2, "follow_target": 3, "track_pgain": 8}),
        ("DVLVelocityTracking", {"type": 2, "target": 3, "beams": 5, "status": 6}),
        ("EntityPlugin_V", {"entity": 2, "plugins": 3}),
        ("WheelSlipParametersCmd", {"entity": 2, "slip_compliance_lateral": 4, "slip_compliance_longitudinal": 5}),
        ("CameraSensor", {"image_noise": 10, "lens": 15, "triggered": 16, "visibility_mask": 19, "pixel_format": 21}),
        ("Projector", {"id": 9, "visibility_flags": 10}),
        ("Sensor", {"lidar": 20, "air_speed": 21}),
        ("Material", {"double_sided": 12, "shininess": 13}),
        ("Marker", {"visibility": 14, "materials": 15}),
        ("Sky", {"cubemap_uri": 10}),
        ("AirSpeed", {"diff_pressure": 2, "temperature": 3}),
    ],
)
def test_numbers_of_what_harmonic_added(name, fields):
    known = message_class(name).DESCRIPTOR.fields_by_name
    assert {field: known[field].number for field in fields} == fields


def test_all_of_gazebo_is_there():
    assert len(registry.file_stems()) == 211
    assert not [
        stem for stem in registry.file_stems() if "reserved" in (registry.PROTO_FOLDER / f"{stem}.proto").read_text()
    ]


def test_a_robot_state_does_not_read_every_file():
    script = (
        "import gz.msgs.model_pb2, gz.msgs.registry as registry\n"
        "assert 'sensor' in registry._loaded and 'scene' not in registry._loaded, registry._loaded\n"
        "assert len(registry._loaded) < 70, len(registry._loaded)\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=600)


def fields_of(name):
    return {field.name: field.number for field in message_class(name).DESCRIPTOR.fields}


def values_of(message, enum):
    kind = message_class(message).DESCRIPTOR
    found = kind.enum_types_by_name.get(enum) or kind.file.enum_types_by_name[enum]
    return {value.name: value.number for value in found.values}


def test_what_gz_msgs_10_has_and_what_it_has_not():
    """Source: https://gazebosim.org/api/msgs/10/, and version 9 for the DVL messages."""
    assert fields_of("Inertial")["fluid_added_mass"] == 10
    assert message_class("Inertial").DESCRIPTOR.fields_by_name["fluid_added_mass"].is_repeated
    assert fields_of("DVLTrackingTarget") == {"type": 1, "range": 2, "position": 3}
    assert fields_of("Parameter") == {"name": 1, "value": 2}
    assert fields_of("ParameterValue") == {"data": 1}
    assert fields_of("AirSpeedSensor") == {"header": 1, "pressure_noise": 4}
    assert values_of("ParameterError", "Type")["SUCCESS"] == 0
    kinds = values_of("SphericalCoordinates", "SphericalCoordinatesType")
    assert kinds == {"SPHERICAL": 0, "ECEF": 1, "GLOBAL": 2, "LOCAL": 3, "LOCAL2": 4}
    assert "DVL_REFERENCE_BEAM" not in values_of("DVLKinematicEstimate", "ReferenceType")
    assert "CONE" not in values_of("ParticleEmitter", "EmitterType")
    assert "gz.msgs.AirFlowSensor" not in type_names()


def test_a_parameter_holds_a_message_of_any_type():
    from gz_course.sim.gz.msgs.parameter_pb2 import Parameter
    from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

    parameter = Parameter(name="/speed")
    parameter.value.Pack(StringMsg(data="fast"))
    read, value = Parameter.FromString(parameter.SerializeToString()), StringMsg()
    assert read.value.TypeName() == "gz.msgs.StringMsg"
    assert read.value.Unpack(value)
    assert value.data == "fast"
