"""The layout in which the viewer opens a recording: the world beside speeds, checks and logs, paused at the start.

Before scoring it is made for the robot alone. Afterwards it knows where the robot went and which checks failed when:
the eye looks at the whole track, and the time of the first failure is selected on the time line.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from gz_course.grader.record.timeline import TIMELINE

Place = tuple[float, float, float]

NEAREST = 2.0  # [m] half the width of the smallest track that is shown as a whole
FROM = (-0.95, -0.95, 1.15)  # where the eye is, in half widths of the track from its middle
MARK_NS = 500_000_000  # width of the mark on the time line [ns]


def blueprint(robot: str, track: tuple[Place, Place] | None = None, failures: Sequence[float] = ()) -> rrb.Blueprint:
    """Return the layout for a run with the model `robot`.

    `track` holds the corners of the box in which the robot drove [m], `failures` the times at which checks failed [s].
    """
    position, target = _sight(track)
    world = rrb.Spatial3DView(
        origin="/world",
        name="World",
        eye_controls=rrb.EyeControls3D(position=position, look_target=target, eye_up=(0.0, 0.0, 1.0)),
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
    columns = rrb.TextLogColumns(timeline_columns=[TIMELINE], text_log_columns=["Body"])
    return rrb.Blueprint(
        rrb.Horizontal(
            world,
            rrb.Vertical(
                speeds,
                rrb.StateTimelineView(origin="/checks", name="Checks"),
                rrb.TextLogView(
                    origin="/log/verdicts",
                    name="Failed checks" if failures else "Verdicts",
                    columns=columns,
                    rows=rrb.TextLogRows(filter_by_log_level=["ERROR"]) if failures else None,
                ),
                rrb.TextLogView(
                    origin="/log", contents=["+ $origin/**", "- $origin/verdicts"], name="Logs", columns=columns
                ),
                row_shares=[3, 3, 3, 2],
            ),
            column_shares=[3, 2],
        ),
        _time_panel(failures),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _sight(track: tuple[Place, Place] | None) -> tuple[Place, Place]:
    """Return the places of the eye and of what it looks at [m]."""
    low, high = np.asarray(track or ((0.0, 0.0, 0.0), (2.0, 1.0, 0.0)))
    target = (low + high) / 2
    width = max(NEAREST, float(np.max(high - low)) / 2 + 1.0)
    x, y, z = (float(v) for v in target)
    return (x + FROM[0] * width * 2, y + FROM[1] * width * 2, z + FROM[2] * width * 2), (x, y, z)


def _time_panel(failures: Sequence[float]) -> rrb.TimePanel:
    if not failures:
        return rrb.TimePanel(timeline=TIMELINE, play_state="paused", state="collapsed")
    first = round(min(failures) * 1e9)
    selection = rr.encodings.AbsoluteTimeRange(first, first + MARK_NS)
    return rrb.TimePanel(timeline=TIMELINE, play_state="paused", state="collapsed", time_selection=selection)
