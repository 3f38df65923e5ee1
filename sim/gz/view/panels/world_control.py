"""World control: play, pause, step and reset a world, with its times and its real time factor.

The buttons call the service `/world/W/control`, as Gazebo's panel of this name does.
"""

from __future__ import annotations

from typing import Any

import mujoco
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.view.window import Window

_MOST_STEPS = 10_000
_GREEN = imgui.Vec4(0.1, 0.48, 0.1, 1.0)
_ORANGE = imgui.Vec4(0.7, 0.33, 0.0, 1.0)
_WHITE = imgui.Vec4(1.0, 1.0, 1.0, 1.0)
_BUTTON = imgui.Vec2(84.0, 0.0)


class Panel:
    """The bar on top."""

    TITLE = "World control"
    PLACE = "top"
    ORDER = 0

    def __init__(self, window: Window) -> None:
        self._window = window
        self.steps = 1

    def build(self) -> None:
        link = self._window.link
        stats = link.stats
        paused = link.paused
        imgui.PushStyleColor(imgui.Col.Button, _GREEN if paused else _ORANGE)
        imgui.PushStyleColor(imgui.Col.Text, _WHITE)
        if imgui.Button("Play" if paused else "Pause", _BUTTON):
            self._window.toggle_pause()
        imgui.PopStyleColor(2)
        imgui.SetItemTooltip("Space")
        imgui.SameLine()
        imgui.BeginDisabled(not paused)
        if imgui.Button("Step"):
            link.step(self.steps)
        imgui.SameLine()
        imgui.SetNextItemWidth(90.0)
        _, wanted = imgui.InputInt("##steps", self.steps)
        self.steps = min(max(1, wanted), _MOST_STEPS)
        imgui.EndDisabled()
        imgui.SameLine()
        if imgui.Button("Reset"):
            link.reset()
        imgui.SameLine()
        if paused:
            imgui.TextColored(_ORANGE, "PAUSED")
        else:
            imgui.TextColored(_GREEN, "running")
        imgui.SameLine()
        if self._window.hidden:
            if imgui.Button("Show all panels"):
                self._window.hidden.clear()
            imgui.SameLine()
        imgui.TextUnformatted(times(stats))

    def geoms(self) -> list[mujoco.MjvGeom]:
        return []

    def close(self) -> None:
        pass


def times(stats: Any) -> str:
    """Return real time factor, simulated time, real time and iterations of a gz.msgs.WorldStatistics as a text."""
    simulated, real = (_clock(each.sec, each.nsec) for each in (stats.sim_time, stats.real_time))
    factor = f"{stats.real_time_factor * 100.0:.0f} %"
    return f"  real time factor {factor}   sim time {simulated}   real time {real}   iterations {stats.iterations}"


def _clock(seconds: int, nanoseconds: int) -> str:
    minutes, rest = divmod(seconds, 60)
    return f"{minutes:02d}:{rest:02d}.{nanoseconds // 1_000_000:03d}"
