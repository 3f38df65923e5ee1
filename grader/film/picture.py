"""One picture of a run: the stage with scan and path drawn into it, and below it the time and the verdicts so far."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.film.stage import Stage, pose_at
from gz_course.grader.record.bodies import chain_of
from gz_course.grader.record.reading import Recording
from gz_course.sim.show.rviz2.drawing import laser_scan, odometry

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

SCAN, PATH = laser_scan.COLOUR, odometry.PATH_COLOUR
GRID, GRID_STEP, GRID_COLOUR = 6.0, 0.2, (178, 182, 186)  # [m]
PATH_STEPS = 400  # points of the path that are drawn
PASSED, FAILED, TEXT, PAPER = (30, 130, 60), (190, 30, 30), (30, 30, 30), (255, 255, 255)
SHOWN = 3  # verdicts that are named at one moment, the last ones
LINE = 1.35  # of the size of the letters


class Pictures:
    """Makes the pictures of one recording, of a width [px] and a height [px] that includes the caption."""

    def __init__(self, recording: Recording, width: int, height: int) -> None:
        self._recording = recording
        self._letters = max(10, round(height / 36))  # size [px]
        self._caption = round(self._letters * LINE * (SHOWN + 0.6))
        self.stage = Stage(recording, width, height - self._caption)
        self._verdicts = recording.lines("log/verdicts") if ("log/verdicts", "TextLog:text") in recording._rows else []
        self._scans = [
            (entity, chain_of(recording, entity))
            for entity in recording.entities("world", "Points3D")
            if len(recording.points_at(entity, recording.end_ns))
        ]

    def at(self, time_ns: int) -> Image:
        """Return the picture of a moment [ns]."""
        from PIL import Image, ImageDraw

        view = Image.fromarray(self.stage.image(time_ns))
        picture = Image.new("RGB", (view.width, view.height + self._caption), PAPER)
        picture.paste(view)
        draw = ImageDraw.Draw(picture)
        self._draw_grid(draw, time_ns)
        size = max(1.0, view.height / 300)
        for points, colour in ((self._path(time_ns), PATH), (self._scan(time_ns), SCAN)):
            pixels, seen = self.stage.project(points)
            for x, y in pixels[seen]:
                draw.ellipse((x - size, y - size, x + size, y + size), fill=colour)
        draw.rectangle((0, view.height, picture.width, picture.height), fill=PAPER)
        self._write(draw, time_ns, view.height, picture.width)
        return picture

    def _draw_grid(self, draw: ImageDraw, time_ns: int) -> None:
        """Draw lines on the ground [1 m apart], because motion over a plain ground cannot be seen."""
        middle = np.round(self.stage.target(time_ns)[:2])
        along = np.arange(-GRID, GRID + 1e-6, GRID_STEP)
        for line in np.arange(-GRID, GRID + 1):
            for points in ((along, np.full_like(along, line)), (np.full_like(along, line), along)):
                ground = np.stack([points[0] + middle[0], points[1] + middle[1], np.full_like(along, 0.005)], axis=1)
                pixels, seen = self.stage.project(ground)
                for number in np.flatnonzero(seen[1:] & seen[:-1]):
                    draw.line([*pixels[number], *pixels[number + 1]], fill=GRID_COLOUR)

    def _path(self, time_ns: int) -> np.ndarray:
        """Return where the robot has been until a moment (n, 3) [m]."""
        poses = self._recording.poses(f"world/{self.stage.robot}")
        if poses is None or len(poses.times) < 2:
            return np.empty((0, 3))
        been = poses.positions[poses.times <= time_ns]
        return been[:: len(been) // PATH_STEPS + 1] + np.array([0.0, 0.0, 0.01])

    def _scan(self, time_ns: int) -> np.ndarray:
        """Return the points of the last scan of each lidar (n, 3) [m], where the lidar is now."""
        clouds = [np.empty((0, 3))]
        for entity, chain in self._scans:
            position, axes = pose_at(chain, time_ns)
            clouds.append(self._recording.points_at(entity, time_ns) @ axes.T + position)
        return np.concatenate(clouds)

    def _write(self, draw: ImageDraw, time_ns: int, top: int, width: int) -> None:
        from PIL import ImageFont

        font = ImageFont.load_default(self._letters)
        run, line = self._recording.properties("run"), self._letters * LINE
        y = top + 0.3 * self._letters
        draw.text((self._letters, y), f"{time_ns / 1e9:.2f} s", fill=TEXT, font=font)
        draw.text((self._letters, y + line), str(run.get("exercise", "")), fill=TEXT, font=font)
        draw.text((self._letters, y + 2 * line), str(run.get("submission", ""))[:24], fill=TEXT, font=font)
        left = 13 * self._letters
        letters = max(10, round((width - left) / (0.5 * self._letters)))
        given = [each for each in self._verdicts if each.time_ns <= time_ns][-SHOWN:]
        for number, each in enumerate(given):
            text = textwrap.shorten(each.text, letters, placeholder=" ...")
            draw.text((left, y + number * line), text, fill=FAILED if each.level == "ERROR" else PASSED, font=font)

    def close(self) -> None:
        self.stage.close()
