import pytest
from google.protobuf.message import DecodeError
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.msgs import canonical_name, message_class, type_names
from gz_course.sim.gz.msgs.fortress import converted, same_type
from gz_course.sim.gz.msgs.imu_pb2 import IMU
from gz_course.sim.gz.msgs.twist_pb2 import Twist

NUMBERS = st.floats(allow_nan=False)


def test_spellings():
    for name in ("ignition.msgs.Twist", "ign_msgs.Twist", "gz_msgs.Twist", ".gz.msgs.Twist", "gz.msgs.Twist"):
        assert canonical_name(name) == "gz.msgs.Twist"
        assert same_type(name, "gz.msgs.Twist")
    assert canonical_name("google.protobuf.Message") == "google.protobuf.Message"
    assert not same_type("ignition.msgs.Twist", "gz.msgs.Pose")


def test_only_the_imu_is_a_class_of_its_own():
    own = [name for name in type_names() if message_class(name.replace("gz.", "ignition.")) is not message_class(name)]
    assert own == ["gz.msgs.IMU"]
    assert message_class("IMU") is message_class("gz.msgs.IMU") is IMU


def test_other_bytes_are_not_even_read():
    data = b"not a message"
    assert converted(data, "ignition.msgs.Twist", "gz.msgs.Twist") is data
    assert converted(data, "gz.msgs.IMU", "gz.msgs.IMU") is data
    with pytest.raises(DecodeError):
        converted(data, "ignition.msgs.IMU", "gz.msgs.IMU")


@given(NUMBERS, NUMBERS, st.text())
def test_an_imu_there_and_back(rate, acceleration, name):
    imu = IMU(entity_name=name)
    imu.orientation.w = 1.0
    imu.angular_velocity.z = rate
    imu.linear_acceleration.x = acceleration
    imu.header.data.add(key="frame_id", value=["imu"])
    old = converted(imu.SerializeToString(), "gz.msgs.IMU", "ignition.msgs.IMU")
    described = message_class("ignition.msgs.IMU").FromString(old)
    assert described.angular_velocity.z == rate
    assert [field.number for field, _ in described.ListFields() if "vel" in field.name] == [4]
    assert [field.number for field, _ in described.ListFields() if "acc" in field.name] == [5]
    assert IMU.FromString(converted(old, "ignition.msgs.IMU", "gz.msgs.IMU")) == imu


def test_covariances_are_lost_on_the_way_to_fortress():
    imu = IMU()
    imu.orientation_covariance.data.append(1.0)
    assert converted(imu.SerializeToString(), "gz.msgs.IMU", "ignition.msgs.IMU") == b""


def test_a_twist_is_a_twist():
    assert message_class("ignition.msgs.Twist") is Twist
