"""nav_msgs/Odometry: the pose as an arrow, the path so far, and the speeds as plots."""

from __future__ import annotations

from typing import Any

from gz_course.sim.show.rviz2.drawing.poses import forward, quaternion, triple

MOST_HZ = 20.0
PATH_COLOUR = (255, 150, 0)


def draw(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    if not canvas.is_due(entity, MOST_HZ):
        return
    pose, twist = message.pose.pose, message.twist.twist
    place, turn = triple(pose.position), quaternion(pose.orientation)
    frame = message.header.frame_id
    canvas.frames.suggest(frame, message.child_frame_id, place, turn)
    canvas.in_frame(f"{entity}/pose", frame)
    arrow = rr.Arrows3D(origins=[place], vectors=[forward(pose.orientation)], colors=[PATH_COLOUR], radii=0.02)
    canvas.log(f"{entity}/pose", arrow)
    if trail := canvas.trail(entity, place):
        canvas.in_frame(f"{entity}/path", frame)
        canvas.log(f"{entity}/path", rr.LineStrips3D([trail], colors=[PATH_COLOUR], radii=0.01))
    canvas.scalar(f"{entity}/twist/linear/x", twist.linear.x)
    canvas.scalar(f"{entity}/twist/angular/z", twist.angular.z)


DRAWN = {"nav_msgs/msg/Odometry": draw}
