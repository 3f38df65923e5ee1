"""The poses of several robots, in one launch argument.

Source: ros-navigation/navigation2 (jazzy), nav2_common/nav2_common/launch/parse_multirobot_pose.py
"""

from __future__ import annotations

import sys
from typing import Any

import yaml

_POSE = ("x", "y", "z", "roll", "pitch", "yaw")


class ParseMultiRobotPose:
    """The launch argument `target_argument` of this program, as in `robots:='a={x: 1.0}; b={x: 2.0, yaw: 1.57}'`."""

    def __init__(self, target_argument: str) -> None:
        begin = f"{target_argument}:="
        given = [word.removeprefix(begin) for word in sys.argv if word.startswith(begin)]
        self._text = given[0] if given else ""

    def value(self) -> dict[str, dict[str, Any]]:
        """Return the pose of each robot [m, rad]; what is not given is 0. Raises ValueError for what is no pose."""
        robots = {}
        for part in filter(None, (part.strip() for part in self._text.split(";"))):
            name, _, text = part.partition("=")
            try:
                pose = yaml.safe_load(text)
            except yaml.YAMLError:
                pose = None
            if not isinstance(pose, dict):
                raise ValueError(f"'{part}' is no pose of a robot; write it as robot1={{x: 1.0, y: 0.5, yaw: 1.57}}")
            robots[name.strip()] = dict.fromkeys(_POSE, 0.0) | pose
        return robots
