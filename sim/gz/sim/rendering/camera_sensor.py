"""The base class of all cameras: lens, pixel rays, camera_info, trigger and image messages.

The cameras of `sensors/` make their images from the ray hits.
As in Gazebo camera_info is published beside the image (`<parent of topic>/camera_info`), and headers carry
`<optical_frame_id>` if it is given, else the sensor's frame.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/CameraSensor.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import SensorBase
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.rendering.pinhole import Pinhole
from gz_course.sim.gz.sim.rendering.point_cloud import fill_cloud
from gz_course.sim.gz.sim.rendering.tile_caster import TileCaster, View
from gz_course.sim.gz.sim.rendering.tiles import Tiles
from gz_course.sim.gz.sim.rendering.viewpoint import ALL_BITS, Floats
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


class CameraSensor(SensorBase):
    """Base of the cameras; `pinhole` is the lens, `caster` casts the rays of its pixels."""

    info_beside = True
    """True if `camera_info` is beside the topic of the camera, False if it is below it."""
    near_hides = True
    """True if surfaces nearer than the near plane are invisible."""
    lens: ClassVar[type[Pinhole]] = Pinhole
    wanted: ClassVar[dict[str, str]] = {}
    """The message type of each published topic, by the suffix of the topic."""

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        element = description.element
        # Defaults of SDF: 320 x 240 pixels, 60 degrees, 0.1 to 100 m.
        camera = element.find("camera") or Element("camera", file=element.file, line=element.line)
        save = camera.find("save")
        if save is not None and save.attributes.get("enabled", "false") in ("true", "1"):
            reason = "images are not written to disk here; subscribe, or record the topic"
            world.diagnostics.warn(save.where, f"<save> of sensor '{description.name}' is ignored: {reason}")
        self.camera = camera
        self.pinhole = self.lens(camera)
        self.noise = Noise.from_sdf(camera.find("noise"))
        self.optical_frame_id = camera.text_of("optical_frame_id", self.frame_id)
        parent = self.topic.rsplit("/", 1)[0] if self.info_beside else self.topic
        self.info_topic = valid_topic(camera.text_of("camera_info_topic"), f"{parent}/camera_info")
        self._triggered = camera.flag("triggered", False)
        self.trigger_topic = valid_topic(camera.text_of("trigger_topic"), f"{self.topic}/trigger")
        self.directions = self.pinhole.directions()
        # A renderer omits surfaces nearer than the near plane and beyond the far plane.
        along = self.directions[:, 0] if self.pinhole.planar else np.ones(len(self.directions))
        near = self.pinhole.near / along if self.near_hides else np.zeros(len(along))
        self._along = along
        tiles = Tiles(self.pinhole.width, self.pinhole.height, self.directions, near, self.pinhole.far / along)
        self.mask = camera.mask("visibility_mask", ALL_BITS)
        self.caster = TileCaster(world, description, tiles, self.mask)
        self.publishers: dict[str, Any] = {}
        self._info: Any = None

    def published(self) -> dict[str, str]:
        """Return the message type of each published topic, by the suffix of the topic."""
        return self.wanted

    def bind(self) -> None:
        self.caster.bind()

    def start(self) -> None:
        super().start()
        self._pending = False

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs import message_class
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.camera_info_pb2 import CameraInfo
        from gz_course.sim.gz.msgs.image_pb2 import Image

        types: dict[str, Any] = {
            kind: message_class(f"gz.msgs.{kind}") for kind in ("Image", *self.published().values())
        }
        self._types = types
        self._info_type = CameraInfo
        self._formats = Image.DESCRIPTOR.file.enum_types_by_name["PixelFormatType"].values_by_name
        self._info = node.advertise(self.info_topic, CameraInfo)
        for suffix, kind in self.published().items():
            self.publishers[suffix] = node.advertise(self.topic + suffix, types[kind])
        if self._triggered:
            node.subscribe(Boolean, self.trigger_topic, self._on_trigger)

    def _on_trigger(self, message: Any) -> None:
        self._pending = bool(message.data)

    def listened(self, suffix: str) -> bool:
        return suffix in self.publishers and self.publishers[suffix].has_connections()

    def has_connections(self) -> bool:
        """Tell whether the camera must be computed: it has a subscriber and, if triggered, a pending trigger."""
        if self._info is None or (self._triggered and not self._pending):
            return False
        return self._info.has_connections() or any(each.has_connections() for each in self.publishers.values())

    def update(self, now_ns: int) -> None:
        self._pending = False
        if self._info.has_connections():
            message = self._info_type()
            self.fill_header(message.header, now_ns)
            self.pinhole.fill_info(message)
            self._info.publish(message)
        if any(each.has_connections() for each in self.publishers.values()):
            self.look(now_ns)

    def look(self, now_ns: int) -> None:
        raise NotImplementedError

    def fill_header(self, header: Any, now_ns: int) -> None:
        super().fill_header(header, now_ns)
        header.data[0].value[0] = self.optical_frame_id

    def cast(self) -> View:
        """Cast the rays of all pixels; surfaces beyond the far plane are not hit."""
        return self.caster.look()

    def depth(self, view: View) -> Floats:
        """Return the distance along the optical axis (n,) [m]; +inf where nothing was hit."""
        return view.tiles.joined(view.depth) * self._along

    def publish_image(self, suffix: str, pixels: NDArray[Any], pixel_format: str, now_ns: int) -> None:
        """Publish pixels (height, width) or (height, width, channels), little-endian and without padding."""
        message = self._types["Image"]()
        self.fill_header(message.header, now_ns)
        message.width, message.height = self.pinhole.width, self.pinhole.height
        data = pixels.tobytes()
        message.step = len(data) // self.pinhole.height
        message.pixel_format_type = self._formats[pixel_format].number
        message.data = data
        self.publishers[suffix].publish(message)

    def publish_cloud(self, suffix: str, points: NDArray[Any], now_ns: int) -> None:
        message = self._types["PointCloudPacked"]()
        self.fill_header(message.header, now_ns)
        fill_cloud(message, points, self.pinhole.height, self.pinhole.width)
        self.publishers[suffix].publish(message)
