"""visualization_msgs/Marker and MarkerArray, in the shapes and with the deletions of RViz.

Source: https://github.com/ros2/common_interfaces/blob/jazzy/visualization_msgs/msg/Marker.msg
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gz_course.sim.show.rviz2.drawing.poses import quaternion, triple

ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST = range(6)
CUBE_LIST, SPHERE_LIST, POINTS, TEXT, MESH, TRIANGLES = range(6, 12)
ADD, DELETE, DELETE_ALL = 0, 2, 3


def draw(canvas: Any, entity: str, message: Any) -> None:
    place = f"{entity}/{message.ns or 'marker'}/{message.id}"
    if message.action == DELETE_ALL:
        canvas.clear(entity)
    elif message.action == DELETE:
        canvas.clear(place)
    elif (shape := _shape(message)) is None:
        canvas.say(f"{entity}: markers of type {message.type} are not drawn")
    else:
        pose = message.pose
        canvas.frames.set(message.header.frame_id, place, triple(pose.position), quaternion(pose.orientation))
        canvas.in_frame(place, place)
        canvas.log(place, shape)


def _shape(marker: Any) -> Any:
    import rerun as rr

    x, y, z = triple(marker.scale)
    colours = [_rgba(each) for each in marker.colors] or [_rgba(marker.color)]
    points = [triple(each) for each in marker.points]
    if marker.type == ARROW and len(points) == 2:
        way = np.subtract(points[1], points[0])
        return rr.Arrows3D(origins=[points[0]], vectors=[way], colors=colours, radii=x / 2)
    if marker.type == ARROW:
        return rr.Arrows3D(vectors=[[x, 0, 0]], colors=colours, radii=y / 2)
    if marker.type == CUBE:
        return rr.Boxes3D(half_sizes=[[x / 2, y / 2, z / 2]], colors=colours, fill_mode="solid")
    if marker.type == SPHERE:
        return rr.Ellipsoids3D(half_sizes=[[x / 2, y / 2, z / 2]], colors=colours, fill_mode="solid")
    if marker.type == CYLINDER:
        return rr.Cylinders3D(lengths=[z], radii=[x / 2], colors=colours, fill_mode="solid")
    if marker.type == LINE_STRIP:
        return rr.LineStrips3D([points], colors=colours[:1], radii=x / 2)
    if marker.type == LINE_LIST:
        pairs = [points[n : n + 2] for n in range(0, len(points) - 1, 2)]
        return rr.LineStrips3D(pairs, colors=colours[:1], radii=x / 2)
    if marker.type == CUBE_LIST:
        return rr.Boxes3D(centers=points, half_sizes=[[x / 2, y / 2, z / 2]], colors=colours, fill_mode="solid")
    if marker.type in (SPHERE_LIST, POINTS):
        return rr.Points3D(points, colors=colours, radii=x / 2)
    if marker.type == TEXT:
        return rr.Points3D([[0, 0, 0]], labels=[marker.text], colors=colours, radii=0.001, show_labels=True)
    if marker.type == TRIANGLES and len(points) >= 3:
        corners = points[: len(points) // 3 * 3]
        return rr.Mesh3D(vertex_positions=corners, albedo_factor=_rgba(marker.color))
    return None


def _rgba(colour: Any) -> list[int]:
    return [round(255 * min(max(each, 0.0), 1.0)) for each in (colour.r, colour.g, colour.b, colour.a)]


def draw_array(canvas: Any, entity: str, message: Any) -> None:
    for each in message.markers:
        draw(canvas, entity, each)


DRAWN = {"visualization_msgs/msg/Marker": draw, "visualization_msgs/msg/MarkerArray": draw_array}
