"""Converts a sensor to gz.msgs.Sensor: name, type, rate, topic, and the fields of its type.

One function under `@describes` writes the fields of each sensor type.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/Conversions.cc
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.gz.msgs.image_pb2 import PixelFormatType
from gz_course.sim.gz.msgs.sensor_noise_pb2 import SensorNoise
from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.scene.fields import set_vector
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

_NO_ELEMENT = Element("none")
_PIXEL_FORMATS = {"R8G8B8": "RGB_INT8", "B8G8R8": "BGR_INT8", "L8": "L_INT8", "L16": "L_INT16"}
_KNOWN_FORMATS = frozenset(PixelFormatType.keys())
_NOISE_TYPES = {"gaussian": SensorNoise.GAUSSIAN, "gaussian_quantized": SensorNoise.GAUSSIAN_QUANTIZED}

_DESCRIBERS: dict[str, Callable[[Any, Element], None]] = {}


def describes(*kinds: str) -> Callable[[Callable[[Any, Element], None]], Callable[[Any, Element], None]]:
    """Register a function that writes the fields of these sensor types."""

    def register(function: Callable[[Any, Element], None]) -> Callable[[Any, Element], None]:
        for kind in kinds:
            _DESCRIBERS[kind] = function
        return function

    return register


def fill_sensor(message: Any, sensor: Sensor, topic: str = "") -> None:
    """Write a sensor into a gz.msgs.Sensor, without ids and pose; `topic` is the topic it publishes on."""
    element = sensor.element
    message.type = sensor.kind
    message.always_on = element.flag("always_on", False)
    message.visualize = element.flag("visualize", False)
    message.update_rate = element.number("update_rate", 0.0)
    message.topic = topic or element.text_of("topic")
    describe = _DESCRIBERS.get(sensor.kind)
    if describe is not None:
        describe(message, element)


def _fill_noise(message: Any, element: Element | None) -> None:
    if element is None:
        return
    noise = Noise.from_sdf(element)
    kind = element.text_of("type") or element.attributes.get("type", "none")
    message.type = _NOISE_TYPES.get(kind, SensorNoise.NONE)
    for name in Noise.__dataclass_fields__:
        setattr(message, name, getattr(noise, name))


@describes("camera", "depth", "depth_camera", "rgbd", "rgbd_camera", "segmentation", "segmentation_camera")
@describes("boundingbox", "boundingbox_camera", "thermal", "thermal_camera")
@describes("wideanglecamera", "wide_angle_camera", "wideangle_camera")
def _camera(message: Any, element: Element) -> None:
    camera = element.find("camera") or _NO_ELEMENT
    to = message.camera
    to.horizontal_fov = camera.number("horizontal_fov", 1.047)
    set_vector(to.image_size, (camera.number("image/width", 320.0), camera.number("image/height", 240.0)))
    to.image_format = camera.text_of("image/format", "R8G8B8")
    named = _PIXEL_FORMATS.get(to.image_format, to.image_format)
    to.pixel_format = PixelFormatType.Value(named) if named in _KNOWN_FORMATS else 0
    to.near_clip, to.far_clip = camera.number("clip/near", 0.1), camera.number("clip/far", 100.0)
    to.is_depth_camera = "depth" in message.type
    depth = camera.find("depth_camera/clip")
    if depth is not None:
        to.depth_near_clip.data, to.depth_far_clip.data = depth.number("near", 0.1), depth.number("far", 10.0)
    distortion = camera.find("distortion")
    if distortion is not None:
        for name in ("k1", "k2", "k3", "p1", "p2"):
            setattr(to.distortion, name, distortion.number(name, 0.0))
        set_vector(to.distortion.center, distortion.vector("center", (0.5, 0.5)))
    noise = camera.find("noise")
    if noise is not None:
        _fill_noise(to.image_noise, noise)
    intrinsics = camera.find("lens/intrinsics")
    if intrinsics is not None:
        for name, default in (("fx", 277.0), ("fy", 277.0), ("cx", 160.0), ("cy", 120.0)):
            setattr(to.lens, f"intrinsics_{name}", intrinsics.number(name, default))
        to.lens.intrinsics_skew = intrinsics.number("s", 0.0)
    to.triggered = camera.flag("triggered", False)
    to.triggered_topic = camera.text_of("trigger_topic")
    to.anti_aliasing = camera.integer("anti_aliasing", 4)
    to.visibility_mask = camera.mask("visibility_mask", 0xFFFFFFFF)
    if "segmentation" in message.type:
        panoptic = camera.text_of("segmentation_type", "semantic") in ("panoptic", "instance")
        to.segmentation_type = to.PANOPTIC if panoptic else to.SEMANTIC


@describes("gpu_lidar", "gpu_ray", "lidar", "ray")
def _lidar(message: Any, element: Element) -> None:
    holder = element.find("lidar") or element.find("ray") or _NO_ELEMENT
    to = message.lidar
    to.display_scan = message.visualize
    for name in ("horizontal", "vertical"):
        scan = holder.find(f"scan/{name}")
        if scan is None:
            setattr(to, f"{name}_samples", 1)
            continue
        setattr(to, f"{name}_samples", scan.integer("samples", 640 if name == "horizontal" else 1))
        setattr(to, f"{name}_resolution", scan.number("resolution", 1.0))
        setattr(to, f"{name}_min_angle", scan.number("min_angle", 0.0))
        setattr(to, f"{name}_max_angle", scan.number("max_angle", 0.0))
    to.range_min, to.range_max = holder.number("range/min", 0.0), holder.number("range/max", 0.0)
    to.range_resolution = holder.number("range/resolution", 0.0)
    noise = holder.find("noise")
    if noise is not None:
        _fill_noise(to.noise, noise)


@describes("imu")
def _imu(message: Any, element: Element) -> None:
    imu = element.find("imu") or _NO_ELEMENT
    for quantity in ("angular_velocity", "linear_acceleration"):
        for axis in "xyz":
            _fill_noise(getattr(getattr(message.imu, quantity), f"{axis}_noise"), imu.find(f"{quantity}/{axis}/noise"))
    frame = imu.find("orientation_reference_frame")
    if frame is not None:
        to = message.imu.orientation_ref_frame
        to.localization = frame.text_of("localization", "CUSTOM")
        set_vector(to.custom_rpy, frame.vector("custom_rpy", (0.0, 0.0, 0.0)))
        set_vector(to.gravity_dir_x, frame.vector("grav_dir_x", (1.0, 0.0, 0.0)))
        for tag, name in (("custom_rpy", "custom_rpy_parent_frame"), ("grav_dir_x", "gravity_dir_x_parent_frame")):
            child = frame.find(tag)
            setattr(to, name, child.attributes.get("parent_frame", "") if child is not None else "")


@describes("altimeter")
def _altimeter(message: Any, element: Element) -> None:
    message.altimeter.SetInParent()
    for quantity in ("vertical_position", "vertical_velocity"):
        _fill_noise(getattr(message.altimeter, f"{quantity}_noise"), element.find(f"altimeter/{quantity}/noise"))


@describes("magnetometer")
def _magnetometer(message: Any, element: Element) -> None:
    message.magnetometer.SetInParent()
    for axis in "xyz":
        _fill_noise(getattr(message.magnetometer, f"{axis}_noise"), element.find(f"magnetometer/{axis}/noise"))


@describes("air_pressure")
def _air_pressure(message: Any, element: Element) -> None:
    message.air_pressure.reference_altitude = element.number("air_pressure/reference_altitude", 0.0)
    _fill_noise(message.air_pressure.pressure_noise, element.find("air_pressure/pressure/noise"))


@describes("air_speed")
def _air_speed(message: Any, element: Element) -> None:
    message.air_speed.SetInParent()
    _fill_noise(message.air_speed.pressure_noise, element.find("air_speed/pressure/noise"))


@describes("navsat", "gps")
def _navsat(message: Any, element: Element) -> None:
    holder = element.find("navsat") or element.find("gps") or _NO_ELEMENT
    message.gps.SetInParent()
    for to, tag in ((message.gps.position, "position_sensing"), (message.gps.velocity, "velocity_sensing")):
        for direction in ("horizontal", "vertical"):
            _fill_noise(getattr(to, f"{direction}_noise"), holder.find(f"{tag}/{direction}/noise"))


@describes("contact")
def _contact(message: Any, element: Element) -> None:
    message.contact.collision_name = element.text_of("contact/collision")


@describes("logical_camera")
def _logical_camera(message: Any, element: Element) -> None:
    camera = element.find("logical_camera") or _NO_ELEMENT
    to = message.logical_camera
    to.near_clip, to.far_clip = camera.number("near", 0.0), camera.number("far", 1.0)
    to.horizontal_fov, to.aspect_ratio = camera.number("horizontal_fov", 1.0), camera.number("aspect_ratio", 1.0)
