"""The layout in which the viewer opens a recording: the world beside speeds, checks and logs, paused at the start."""

from __future__ import annotations

import rerun.blueprint as rrb

from gz_course.grader.record.timeline import TIMELINE


def blueprint(robot: str) -> rrb.Blueprint:
    """Return the layout for a run with the robot model `robot`."""
    world = rrb.Spatial3DView(
        origin="/world",
        name="World",
        eye_controls=rrb.EyeControls3D(position=(-4.5, -4.5, 5.0), look_target=(1.0, 0.5, 0.0), eye_up=(0.0, 0.0, 1.0)),
    )
    speeds = rrb.TimeSeriesView(
        origin="/",
        contents=[
            f"/truth/{robot}/linear_x",
            f"/truth/{robot}/angular_z",
            "/topics/cmd_vel/linear/x",
            "/topics/cmd_vel/angular/z",
            "/topics/nearest_obstacle/data",
        ],
        name="Truth and commands",
    )
    return rrb.Blueprint(
        rrb.Horizontal(
            world,
            rrb.Vertical(
                speeds,
                rrb.StateTimelineView(origin="/checks", name="Checks"),
                rrb.TextLogView(origin="/log", name="Logs"),
            ),
            column_shares=[3, 2],
        ),
        rrb.TimePanel(timeline=TIMELINE, play_state="paused", state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )
