"""A model of a gz.msgs.Scene as the text of `gz model`: its pose, links, sensors and joints.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/cmd/ModelCommandAPI.cc
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

_HEADING = "- Pose [ XYZ (m) ] [ RPY (rad) ]:"
_NOISE = (
    ("Mean", "mean", True),
    ("Bias mean", "bias_mean", True),
    ("Standard deviation", "stddev", True),
    ("Bias standard deviation", "bias_stddev", True),
    ("Precision", "precision", False),
    ("Dynamic bias standard deviation", "dynamic_bias_stddev", True),
)


def model_lines(model: Any, pose: Any) -> Iterator[str]:
    """Yield id, name and the present `pose` of a model."""
    yield f"Model: [{model.id}]"
    yield from _indented(2, [f"- Name: {model.name}", *_pose(pose)])


def link_lines(model: Any, links: Iterable[Any]) -> Iterator[str]:
    """Yield links of a model with their masses and sensors."""
    for link in links:
        yield f"- Link [{link.id}]"
        moments = link.inertial
        rows = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
        lines = [
            f"- Name: {link.name}",
            f"- Parent: {model.name} [{model.id}]",
            f"- Mass (kg): {moments.mass:.6f}",
            "- Inertial Pose [ XYZ (m) ] [ RPY (rad) ]:",
            *_pose(moments.pose)[1:],
            "- Inertial Matrix (kg.m^2):",
            *(f"  [{' '.join(f'{getattr(moments, name):.6f}' for name in row)}]" for row in rows),
            *_pose(link.pose),
            *sensor_lines(model, link.sensor),
        ]
        yield from _indented(2, lines)


def sensor_lines(model: Any, sensors: Iterable[Any]) -> Iterator[str]:
    """Yield sensors of a model with what their type has; type, rate and topic are ours."""
    for sensor in sensors:
        yield f"- Sensor [{sensor.id}]"
        lines = [
            f"- Name: {sensor.name}",
            f"- Parent: {model.name} [{model.id}]",
            *_pose(sensor.pose),
            f"- Type: {sensor.type}",
            f"- Update rate (Hz): {sensor.update_rate:g}",
            f"- Topic: {sensor.topic}",
        ]
        for field, write in _TYPES.items():
            if sensor.HasField(field):
                lines += write(getattr(sensor, field))
        yield from _indented(2, lines)


def joint_lines(model: Any, joints: Iterable[Any]) -> Iterator[str]:
    """Yield joints of a model."""
    for joint in joints:
        yield f"- Joint [{joint.id}]"
        lines = [
            f"- Name: {joint.name}",
            f"- Parent: {model.name} [{model.id}]",
            f"- Type: {joint.Type.Name(joint.type).lower()}",
            f"- Parent Link: {_with_id(joint.parent, joint.parent_id)}",
            f"- Child Link: {_with_id(joint.child, joint.child_id)}",
            *_pose(joint.pose),
        ]
        if joint.HasField("axis1"):
            axis = joint.axis1.xyz
            words = " ".join(f"{0.0 if abs(value) < 1e-12 else value:g}" for value in (axis.x, axis.y, axis.z))
            lines += ["- Axis unit vector [ XYZ ]:", f"  [{words}]"]
        yield from _indented(2, lines)


def _indented(depth: int, lines: Iterable[str]) -> Iterator[str]:
    return (" " * depth + each for each in lines)


def _with_id(name: str, number: int) -> str:
    return f"{name} [{number}]" if number else name


def _pose(pose: Any) -> list[str]:
    w, x, y, z = pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z
    sine = max(-1.0, min(1.0, 2.0 * (w * y - z * x)))
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return [
        _HEADING,
        f"  [{pose.position.x:.6f} {pose.position.y:.6f} {pose.position.z:.6f}]",
        f"  [{roll:.6f} {math.asin(sine):.6f} {yaw:.6f}]",
    ]


def _noise(title: str, noise: Any, unit: str = "") -> list[str]:
    shown = f" ({unit})" if unit else ""
    lines = [f"- {text}{shown if has_unit else ''}: {getattr(noise, name):g}" for text, name, has_unit in _NOISE]
    lines.append(f"- Dynamic bias correlation time (s): {noise.dynamic_bias_correlation_time:g}")
    return [f"- {title}:", *_indented(2, lines)]


def _air_pressure(air: Any) -> list[str]:
    height = f"- Reference altitude (m): {air.reference_altitude:g}"
    return [height, *_noise("Pressure noise", air.pressure_noise, "Pa")]


def _altimeter(altimeter: Any) -> list[str]:
    return [
        *_noise("Vertical position noise", altimeter.vertical_position_noise, "m"),
        *_noise("Vertical velocity noise", altimeter.vertical_velocity_noise, "m/s"),
    ]


def _camera(camera: Any) -> list[str]:
    lines = [
        f"- Horizontal field of view (rad): {camera.horizontal_fov:g}",
        f"- Image width (px): {camera.image_size.x:g}",
        f"- Image height (px): {camera.image_size.y:g}",
        f"- Near clip (m): {camera.near_clip:g}",
        f"- Far clip (m): {camera.far_clip:g}",
        f"- Pixel format: {camera.image_format}",
    ]
    if camera.HasField("depth_near_clip"):
        lines.append(f"- Depth near clip (m): {camera.depth_near_clip.data:g}")
        lines.append(f"- Depth far clip (m): {camera.depth_far_clip.data:g}")
    if camera.segmentation_type:
        lines.append(f"- Segmentation type: {camera.SegmentationType.Name(camera.segmentation_type).lower()}")
    lines += _noise("Image noise", camera.image_noise)
    bent = camera.distortion
    lines += (f"- Distortion {name.upper()}: {getattr(bent, name):g}" for name in ("k1", "k2", "k3", "p1", "p2"))
    lines.append(f"- Distortion center: {bent.center.x:g} {bent.center.y:g}")
    if camera.HasField("lens"):
        for name in ("fx", "fy", "cx", "cy", "skew"):
            shown = name if name == "skew" else name.capitalize()
            lines.append(f"- Lens intrinsics {shown}: {getattr(camera.lens, f'intrinsics_{name}'):g}")
    return [*lines, f"- Visibility mask: {camera.visibility_mask}"]


def _lidar(lidar: Any) -> list[str]:
    lines = ["- Range:"]
    lines += (f"  - {text}: {getattr(lidar, f'range_{name}'):g}" for text, name in _RANGE)
    for direction in ("horizontal", "vertical"):
        lines.append(f"- {direction.capitalize()} scan:")
        lines += (f"  - {text}: {getattr(lidar, f'{direction}_{name}'):g}" for text, name in _SCAN)
    return [*lines, *_noise("Noise", lidar.noise, "m")]


_RANGE = (("Min (m)", "min"), ("Max (m)", "max"), ("Resolution", "resolution"))
_SCAN = (
    ("Samples", "samples"),
    ("Resolution", "resolution"),
    ("Min angle (rad)", "min_angle"),
    ("Max angle (rad)", "max_angle"),
)


def _imu(imu: Any) -> list[str]:
    lines: list[str] = []
    for text, name, unit in (
        ("Linear acceleration", "linear_acceleration", "m/s^2"),
        ("Angular velocity", "angular_velocity", "rad/s"),
    ):
        for axis in "xyz":
            lines += _noise(f"{text} {axis.upper()}-axis noise", getattr(getattr(imu, name), f"{axis}_noise"), unit)
    frame = imu.orientation_ref_frame
    gravity, turn = frame.gravity_dir_x, frame.custom_rpy
    return [
        *lines,
        f"- Gravity direction X [XYZ]: {gravity.x:g} {gravity.y:g} {gravity.z:g}",
        f"- Gravity direction X parent frame:{frame.gravity_dir_x_parent_frame}",
        f"- Localization:{frame.localization}",
        f"- Custom RPY: {turn.x:g} {turn.y:g} {turn.z:g}",
        f"- Custom RPY parent frame:{frame.custom_rpy_parent_frame}",
    ]


def _magnetometer(magnetometer: Any) -> list[str]:
    lines: list[str] = []
    for axis in "xyz":
        lines += _noise(f"{axis.upper()}-axis noise", getattr(magnetometer, f"{axis}_noise"), "T")
    return lines


_TYPES = {
    "air_pressure": _air_pressure,
    "altimeter": _altimeter,
    "camera": _camera,
    "lidar": _lidar,
    "imu": _imu,
    "magnetometer": _magnetometer,
}
