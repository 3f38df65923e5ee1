"""tf2_msgs/TFMessage: the tree of coordinate frames, each with its axes."""

from __future__ import annotations

from typing import Any

from gz_course.sim.show.rviz2.drawing.poses import quaternion, triple


def draw(canvas: Any, entity: str, message: Any) -> None:
    for each in message.transforms:
        turn = quaternion(each.transform.rotation)
        canvas.frames.set(each.header.frame_id, each.child_frame_id, triple(each.transform.translation), turn)


DRAWN = {"tf2_msgs/msg/TFMessage": draw}
