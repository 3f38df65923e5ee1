"""The cheat sheet of the course: topics, types, bridge, QoS, launch and commands on two printed pages.

`python -m gz_course.grader.tools.book.cheat_sheet` writes `chapters/cheat_sheet.html` from the tables of the code: the
exercises' bridges, the type pairs, the marks and keys of the bridge, its QoS profiles, and the commands that there are.
Only the examples are written here.
"""

from __future__ import annotations

import ast
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import yaml
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from gz_course.grader import commands as course_commands
from gz_course.grader.course import INSTRUCTORS, section, summary
from gz_course.grader.exercise import course_root, exercise_names, find_exercise
from gz_course.grader.registry import module_names
from gz_course.sim.bridge.ros_gz_bridge.arguments import MARK_OF, MARKS
from gz_course.sim.bridge.ros_gz_bridge.entry import Direction
from gz_course.sim.bridge.ros_gz_bridge.entry_reader import KEYS
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import DEFAULT_DEPTH, QOS_PROFILES
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import pairs
from gz_course.sim.gz.command import find_commands
from gz_course.sim.gz.command import summary as gz_summary
from gz_course.sim.ros.ros2.command_line import COMMANDS, found

CHEAT_SHEET = Path("chapters/cheat_sheet.html")
ARROWS = {Direction.GZ_TO_ROS: "→ ROS", Direction.ROS_TO_GZ: "→ Gazebo", Direction.BIDIRECTIONAL: "both ways"}
# One example for each command of `ros2` that the chapters use; the others are listed by name.
EXAMPLES = {
    "action": "ros2 action send_goal /patrol patrol_interfaces/action/Patrol '{speed: 0.3}' --feedback",
    "bag": "ros2 bag record -o my_bag /scan /odom",
    "interface": "ros2 interface show geometry_msgs/msg/Twist",
    "launch": "ros2 launch bringup.launch.py world:=warehouse.sdf",
    "node": "ros2 node info /ros_gz_bridge",
    "param": "ros2 param set /wall_follower distance 0.9",
    "pkg": "ros2 pkg executables ros_gz_bridge",
    "run": "ros2 run tf2_ros tf2_echo odom base_link",
    "service": "ros2 service call /reset std_srvs/srv/Trigger",
    "topic": "ros2 topic pub --once /cmd_vel geometry_msgs/msg/Twist '{linear: {x: 0.2}}'",
}


@dataclass(frozen=True)
class Bridged:
    """One topic of the course's robots: its two names, its two types, and the mark of its direction."""

    ros_topic: str
    ros_type: str
    mark: str
    arrow: str
    gz_topic: str
    gz_type: str


def bridged(root: Path) -> list[Bridged]:
    """Return the topics in the bridge files that exercises give to nodes, each once, sorted by the name in ROS."""
    exercises = (find_exercise(name, root) for name in exercise_names(root))
    files = [each.bridge for each in exercises if each.bridge is not None and each.kind in ("node", "package")]
    rows = set()
    for path in files:
        for each in yaml.safe_load(path.read_text()):
            way = Direction(each["direction"])
            names = each["ros_topic_name"], each["ros_type_name"], MARK_OF[way], ARROWS[way]
            rows.add(Bridged(*names, each["gz_topic_name"], each["gz_type_name"]))
    return sorted(rows, key=lambda row: (row.ros_topic, row.gz_topic))


def type_pairs() -> dict[str, list[str]]:
    """Return the pairs of types by ROS package: `Twist`, or `Imu = IMU` where the names differ.

    A type with several partners names them all: `Pose = Pose, Pose_V`.
    """
    partners: dict[str, dict[str, list[str]]] = {}
    for pair in pairs():
        package, _, name = pair.ros_type.partition("/msg/")
        partners.setdefault(package, {}).setdefault(name, []).append(pair.gz_type.removeprefix("gz.msgs."))
    return {
        package: [name if gz == [name] else f"{name} = {' | '.join(gz)}" for name, gz in names.items()]
        for package, names in partners.items()
    }


def commands_of_course() -> list[tuple[str, str]]:
    """Return the commands for students, each with the first sentence of its help."""
    folder = Path(course_commands.__path__[0])
    modules = {name: ast.parse((folder / f"{name}.py").read_bytes()) for name in module_names(course_commands)}
    return [
        (name.replace("_", "-"), _first(summary(module)))
        for name, module in modules.items()
        if section(module) != INSTRUCTORS
    ]


def commands_of_ros() -> list[tuple[str, str, str]]:
    """Return the commands of `ros2`: name, verbs, and an example or nothing."""
    there = found(COMMANDS)
    verbs = {name: ", ".join(sorted(found(path))) if path.is_dir() else "" for name, path in there.items()}
    return [(name, verbs[name], EXAMPLES.get(name, "")) for name in sorted(there)]


def cheat_sheet(root: Path) -> str:
    """Return the cheat sheet of the course at `root` as a page that needs nothing else."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["code"] = lambda text: Markup(re.sub("`([^`]*)`", r"<code>\1</code>", str(escape(text))))
    text = environment.get_template("cheat_sheet.html.jinja").render(
        bridged=bridged(root),
        pairs=type_pairs(),
        marks=[(mark, way.value, ARROWS[way]) for mark, way in MARKS.items()],
        keys=KEYS,
        profiles=QOS_PROFILES,
        default_depth=DEFAULT_DEPTH,
        gz=[(name, gz_summary(path)) for name, path in find_commands().items()],
        ros=commands_of_ros(),
        course=commands_of_course(),
    )
    return text if text.endswith("\n") else f"{text}\n"


def _first(text: str) -> str:
    return re.split(r"[.;:] ", text, maxsplit=1)[0].rstrip(".")


def main() -> int:
    root = course_root()
    (root / CHEAT_SHEET).write_text(cheat_sheet(root))
    print(root / CHEAT_SHEET)
    return 0


if __name__ == "__main__":
    sys.exit(main())
