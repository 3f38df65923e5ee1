"""The layout of the live view: the world, pictures, plots and logs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from gz_course.sim.show.rviz2.canvas import TIMELINE

if TYPE_CHECKING:
    from rerun.blueprint import Blueprint


def layout(pictures: Sequence[str], plots: Sequence[str] = (), fixed_frame: str = "") -> Blueprint:
    """Return the layout for entities with pictures, chosen plots (`/odom/twist/linear/x`; none: all) and a frame."""
    import rerun as rr
    import rerun.blueprint as rrb

    eye = rrb.EyeControls3D(position=(-3.0, -3.0, 3.0), look_target=(0.0, 0.0, 0.0), eye_up=(0.0, 0.0, 1.0))
    target = rrb.SpatialInformation(target_frame=fixed_frame) if fixed_frame else None
    world = rrb.Spatial3DView(
        origin="/",
        contents=["/topics/**", "/tf/**", *(f"- {each}" for each in pictures)],
        name="World" if not fixed_frame else f"World, in {fixed_frame}",
        eye_controls=eye,
        spatial_information=target,
    )
    contents = [f"/plots{each if each.startswith('/') else '/' + each}" for each in plots] or ["/plots/**"]
    recent = rr.VisibleTimeRange(
        TIMELINE,
        start=rr.TimeRangeBoundary.cursor_relative(seconds=-30.0),
        end=rr.TimeRangeBoundary.cursor_relative(),
    )
    beside: list[rrb.Container | rrb.View] = []
    if pictures:
        views = [rrb.Spatial2DView(origin=each, name=each.removeprefix("/topics")) for each in pictures]
        beside.append(rrb.Tabs(*views) if len(views) > 1 else views[0])
    beside.append(rrb.TimeSeriesView(origin="/plots", contents=contents, name="Plots", time_ranges=[recent]))
    beside.append(rrb.TextLogView(origin="/log", name="Log"))
    return rrb.Blueprint(
        rrb.Horizontal(world, rrb.Vertical(*beside), column_shares=[3, 2]),
        rrb.TimePanel(timeline=TIMELINE, play_state="following", state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )
