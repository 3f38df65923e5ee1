"""nav_msgs/OccupancyGrid: a map in RViz's colours, at its origin.

Source: https://docs.ros2.org/latest/api/nav_msgs/msg/OccupancyGrid.html
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gz_course.sim.show.rviz2.drawing.poses import quaternion, triple


def draw(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    info = message.info
    cells = np.asarray(message.data, dtype=np.int8)
    if not (info.width and info.height and len(cells) == info.width * info.height):
        return
    canvas.in_frame(entity, message.header.frame_id)
    grid = rr.GridMap(
        data=cells.view(np.uint8).reshape(info.height, info.width)[::-1].tobytes(),
        format=rr.components.ImageFormat(width=info.width, height=info.height, color_model="L", channel_datatype="U8"),
        cell_size=info.resolution,
        translation=triple(info.origin.position),
        quaternion=quaternion(info.origin.orientation),
        colormap="RvizMap",
    )
    canvas.log(entity, grid)


DRAWN = {"nav_msgs/msg/OccupancyGrid": draw}
