"""ROS messages of any class for property-based tests, and messages as comparable plain values."""

import importlib
import math
import re
from array import array

import numpy as np
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterValue
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Header

from gz_course.sim.bridge.ros_gz_bridge.convert.sensor_msgs.cameras import ENCODINGS

SCALARS = {
    "boolean": st.booleans(),
    "double": st.floats(),
    "float": st.floats(width=32),
    "int32": st.integers(-(2**31), 2**31 - 1),
    "uint32": st.integers(0, 2**32 - 1),
    "uint8": st.integers(0, 255),
    "int8": st.integers(-128, 127),
    "int16": st.integers(-(2**15), 2**15 - 1),
    "int64": st.integers(-(2**63), 2**63 - 1),
    "uint16": st.integers(0, 2**16 - 1),
    "uint64": st.integers(0, 2**64 - 1),
    "string": st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=20),
}


def messages(ros_class):
    """Return a strategy for the messages of a class, from its type description."""
    if ros_class.__name__ in _SPECIAL:
        return _SPECIAL[ros_class.__name__]()
    fields = ros_class.get_fields_and_field_types()
    return st.builds(ros_class, **{name: _values(ros_class, name, kind) for name, kind in fields.items()})


def _values(ros_class, name, kind):
    if (ros_class.__name__, name) in _LIMITS:
        return _LIMITS[ros_class.__name__, name]
    if kind in SCALARS:
        return SCALARS[kind]
    if listed := re.fullmatch(r"sequence<(.+)>", kind):
        code = {"float": "f", "double": "d", "int32": "i", "uint8": "B"}.get(listed[1])
        items = st.lists(_values(ros_class, "", listed[1]), max_size=4 if "/" in listed[1] else 10)
        return items if code is None else items.map(lambda numbers: array(code, numbers))
    if fixed := re.fullmatch(r"(double|float)\[(\d+)\]", kind):
        size = int(fixed[2])
        dtype = np.float64 if fixed[1] == "double" else np.float32
        return st.lists(st.floats(width=32), min_size=size, max_size=size).map(lambda n: np.array(n, dtype=dtype))
    package, _, class_name = kind.partition("/")
    module = importlib.import_module(f"{package}.msg")
    return messages(getattr(module, class_name))


_LIMITS = {
    ("Time", "nanosec"): st.integers(0, 999_999_999),
    ("Duration", "nanosec"): st.integers(0, 999_999_999),
    ("PointField", "datatype"): st.integers(1, 8),
    ("BatteryState", "power_supply_status"): st.integers(0, 4),
    ("CameraInfo", "distortion_model"): st.sampled_from(["plumb_bob", "rational_polynomial", "equidistant"]),
}


@st.composite
def images(draw):
    encoding = draw(st.sampled_from(sorted(ENCODINGS)))
    width, height, padding = draw(st.integers(0, 5)), draw(st.integers(0, 5)), draw(st.integers(0, 3))
    step = width * ENCODINGS[encoding][1] + padding
    data = draw(st.binary(min_size=step * height, max_size=step * height))
    header = draw(messages(Header))
    return Image(header=header, width=width, height=height, step=step, encoding=encoding, data=array("B", data))


@st.composite
def joint_states(draw):
    joints = draw(st.lists(SCALARS["string"], max_size=5))
    numbers = [
        array("d", draw(st.one_of(st.just([]), st.lists(st.floats(), min_size=len(joints), max_size=len(joints)))))
        for _ in range(3)
    ]
    header = draw(messages(Header))
    return JointState(header=header, name=joints, position=numbers[0], velocity=numbers[1], effort=numbers[2])


@st.composite
def parameter_values(draw):
    kind = draw(st.integers(0, 4))
    field = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value"}.get(kind)
    values = {1: st.booleans(), 2: SCALARS["int32"], 3: st.floats(), 4: SCALARS["string"]}
    return ParameterValue(type=kind, **({field: draw(values[kind])} if field else {}))


_SPECIAL = {"Image": images, "JointState": joint_states, "ParameterValue": parameter_values}


def plain(message):
    """Return a message as nested dicts in which nan equals nan."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: plain(getattr(message, name)) for name in message.get_fields_and_field_types()}
    if isinstance(message, (array, np.ndarray, list, tuple)):
        return [plain(item) for item in message]
    if isinstance(message, float):
        return "nan" if math.isnan(message) else message
    return message
