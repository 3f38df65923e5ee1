"""vision_msgs: objects found in images and in space, as boxes with a label.

Source: ros_gz_bridge/src/convert/vision_msgs.cpp; vision_msgs, https://github.com/ros-perception/vision_msgs
"""

from __future__ import annotations

from typing import Any

from vision_msgs import msg

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import copy_xyz, copy_xyzw
from gz_course.sim.bridge.ros_gz_bridge.fields import HEADER, Each, Fields, Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError

_LABELS = range(2**32)


def _fill_label(gz: Any, ros: msg.Detection2D | msg.Detection3D) -> None:
    """Write the header, and the label of Gazebo as the only hypothesis with score 1."""
    fill_header(gz.header, ros.header)
    ros.results = [msg.ObjectHypothesisWithPose(hypothesis=msg.ObjectHypothesis(class_id=str(gz.label), score=1.0))]


def _copy_label(ros: msg.Detection2D | msg.Detection3D, gz: Any) -> None:
    """Write the header and the label of the most probable hypothesis; 0 if there is none."""
    copy_header(ros.header, gz.header)
    if not ros.results:
        return
    text = max(ros.results, key=lambda result: float(result.hypothesis.score)).hypothesis.class_id
    if not (text.isascii() and text.isdigit() and len(text) <= 10 and int(text) in _LABELS):
        raise ConversionError(f"the class_id {text!r} is not a label of Gazebo (a number from 0 to 4294967295)")
    gz.label = int(text)


def _fill_2d(gz: Any, ros: msg.Detection2D) -> None:
    """Write two corners of a `gz.msgs.AnnotatedAxisAligned2DBox` as centre and size [px]."""
    _fill_label(gz, ros)
    low, high, box = gz.box.min_corner, gz.box.max_corner, ros.bbox
    box.center.position.x, box.center.position.y = (low.x + high.x) / 2, (low.y + high.y) / 2
    box.size_x, box.size_y = high.x - low.x, high.y - low.y


def _copy_2d(ros: msg.Detection2D, gz: Any) -> None:
    """Write centre and size as two corners. Raises ConversionError for a rotated box."""
    _copy_label(ros, gz)
    box, center, low, high = ros.bbox, ros.bbox.center.position, gz.box.min_corner, gz.box.max_corner
    if box.center.theta:
        raise ConversionError(f"the box is turned by {box.center.theta} rad; Gazebo's boxes in images are not turned")
    low.x, low.y = center.x - box.size_x / 2, center.y - box.size_y / 2
    high.x, high.y = center.x + box.size_x / 2, center.y + box.size_y / 2


def _fill_3d(gz: Any, ros: msg.Detection3D) -> None:
    """Write centre, orientation and size [m] of a `gz.msgs.AnnotatedOriented3DBox`."""
    _fill_label(gz, ros)
    copy_xyz(gz.box.center, ros.bbox.center.position)
    copy_xyzw(gz.box.orientation, ros.bbox.center.orientation)
    copy_xyz(gz.box.boxSize, ros.bbox.size)


def _copy_3d(ros: msg.Detection3D, gz: Any) -> None:
    _copy_label(ros, gz)
    copy_xyz(ros.bbox.center.position, gz.box.center)
    copy_xyzw(ros.bbox.center.orientation, gz.box.orientation)
    copy_xyz(ros.bbox.size, gz.box.boxSize)


for _ros_class, _list_class, _gz_type, _part in (
    (
        msg.Detection2D,
        msg.Detection2DArray,
        "gz.msgs.AnnotatedAxisAligned2DBox",
        Part(msg.Detection2D, _fill_2d, _copy_2d),
    ),
    (
        msg.Detection3D,
        msg.Detection3DArray,
        "gz.msgs.AnnotatedOriented3DBox",
        Part(msg.Detection3D, _fill_3d, _copy_3d),
    ),
):
    message_pair(f"vision_msgs/msg/{_ros_class.__name__}", _gz_type, _part)
    message_pair(
        f"vision_msgs/msg/{_list_class.__name__}",
        f"{_gz_type}_V",
        Fields(_list_class, {"detections": "annotated_box"}, header=HEADER, detections=Each(_part)),
    )
