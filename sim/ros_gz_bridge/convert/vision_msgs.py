"""vision_msgs: objects found in images and in space, as boxes with a label."""

from __future__ import annotations

from typing import Any

from vision_msgs.msg import (
    Detection2D,
    Detection2DArray,
    Detection3D,
    Detection3DArray,
    ObjectHypothesis,
    ObjectHypothesisWithPose,
)

from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import (
    copy_xyz,
    copy_xyzw,
    point_to_ros,
    quaternion_to_ros,
    vector_to_ros,
)
from gz_course.sim.ros_gz_bridge.fields import HEADER, Each, Fields, Part, add_fields
from gz_course.sim.ros_gz_bridge.header import header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError

_LABELS = range(2**32)


def _results_to_ros(label: int) -> list[ObjectHypothesisWithPose]:
    """Gazebo's one label as the only hypothesis, and a certain one."""
    return [ObjectHypothesisWithPose(hypothesis=ObjectHypothesis(class_id=str(label), score=1.0))]


def _label(results: list[ObjectHypothesisWithPose]) -> int:
    """The label of the most probable hypothesis; 0 if there is none."""
    if not results:
        return 0
    text = max(results, key=lambda result: float(result.hypothesis.score)).hypothesis.class_id
    if not (text.isascii() and text.isdigit() and len(text) <= 10 and int(text) in _LABELS):
        raise ConversionError(f"the class_id {text!r} is not a label of Gazebo (a number from 0 to 4294967295)")
    return int(text)


def detection_2d_to_ros(gz: Any) -> Detection2D:
    """A ``gz.msgs.AnnotatedAxisAligned2DBox``: two corners become centre and size, in pixels."""
    ros = Detection2D(header=header_to_ros(gz.header), results=_results_to_ros(gz.label))
    low, high = gz.box.min_corner, gz.box.max_corner
    ros.bbox.center.position.x = (low.x + high.x) / 2
    ros.bbox.center.position.y = (low.y + high.y) / 2
    ros.bbox.size_x, ros.bbox.size_y = high.x - low.x, high.y - low.y
    return ros


def detection_2d_to_gz(ros: Detection2D, gz: Any) -> None:
    """Write into a ``gz.msgs.AnnotatedAxisAligned2DBox``, whose box cannot be turned."""
    header_to_gz(ros.header, gz.header)
    gz.label = _label(ros.results)
    box, center = ros.bbox, ros.bbox.center.position
    if ros.bbox.center.theta:
        raise ConversionError(f"the box is turned by {box.center.theta} rad; Gazebo's boxes in images are not turned")
    gz.box.min_corner.x, gz.box.min_corner.y = center.x - box.size_x / 2, center.y - box.size_y / 2
    gz.box.max_corner.x, gz.box.max_corner.y = center.x + box.size_x / 2, center.y + box.size_y / 2


def detection_3d_to_ros(gz: Any) -> Detection3D:
    """A ``gz.msgs.AnnotatedOriented3DBox``: centre, orientation and size in metres."""
    ros = Detection3D(header=header_to_ros(gz.header), results=_results_to_ros(gz.label))
    ros.bbox.center.position = point_to_ros(gz.box.center)
    ros.bbox.center.orientation = quaternion_to_ros(gz.box.orientation)
    ros.bbox.size = vector_to_ros(gz.box.boxSize)
    return ros


def detection_3d_to_gz(ros: Detection3D, gz: Any) -> None:
    """Write into a ``gz.msgs.AnnotatedOriented3DBox``."""
    header_to_gz(ros.header, gz.header)
    gz.label = _label(ros.results)
    copy_xyz(ros.bbox.center.position, gz.box.center)
    copy_xyzw(ros.bbox.center.orientation, gz.box.orientation)
    copy_xyz(ros.bbox.size, gz.box.boxSize)


_BOX_2D = Part(detection_2d_to_ros, detection_2d_to_gz)
_BOX_3D = Part(detection_3d_to_ros, detection_3d_to_gz)
_RENAMED = {"detections": "annotated_box"}

add_fields("vision_msgs/msg/Detection2D", "gz.msgs.AnnotatedAxisAligned2DBox", _BOX_2D)
add_fields(
    "vision_msgs/msg/Detection2DArray",
    "gz.msgs.AnnotatedAxisAligned2DBox_V",
    Fields(Detection2DArray, _RENAMED, header=HEADER, detections=Each(_BOX_2D)),
)
add_fields("vision_msgs/msg/Detection3D", "gz.msgs.AnnotatedOriented3DBox", _BOX_3D)
add_fields(
    "vision_msgs/msg/Detection3DArray",
    "gz.msgs.AnnotatedOriented3DBox_V",
    Fields(Detection3DArray, _RENAMED, header=HEADER, detections=Each(_BOX_3D)),
)
