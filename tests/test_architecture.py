"""The laws of the house: which module may import which, how long a file may be, which names exist."""

import ast
import functools
import importlib
import json
import pkgutil
import re
import subprocess
import sys

import pytest

from gz_course.tests.import_arrows import (
    NAMESPACE,
    ROOT,
    SIDES,
    below,
    cycles,
    imports,
    modules,
    place,
    reachable,
    tree,
)

PUBLIC_NAMES = {path.name for path in (ROOT / "public").iterdir() if path.is_dir()} - {"gz_course", "__pycache__"}
NO_CODE = {"__pycache__", "interfaces"}
PACKAGES = {
    path.relative_to(ROOT / "sim").as_posix()
    for side in SIDES
    for path in (ROOT / "sim" / side).iterdir()
    if path.is_dir() and path.name not in NO_CODE
} - {f"gz/{part}" for part in ("sim", "msgs", "transport")} | {"gz"}
CODE_FOLDERS = ("sim", "grader", "public", "exercises", "solutions", "chapters", "tests")
LONGEST_FILE = 400
VAGUE_NAMES = {"utils", "util", "helpers", "helper", "common", "misc"}
HEAVY = {"mujoco", "rclpy", "rerun"}

AGENT = "grader/run/agent"  # what is put before the student's own code, in the student's process
RUNNING = ("grader/run", "sim/gz", "sim/bridge/ros_gz_bridge")
ROS = ("rclpy", "rosidl_runtime_py", "ament_index_python")
ROS_MESSAGES = r"\w+_(msgs|interfaces)(/|$)"

# What a room must not import, imports for types and imports inside functions included. The rules of a room hold
# for the rooms in it too.
FORBIDDEN = {
    "sim": ("grader", "chapters", "exercises", "solutions"),
    "grader": ("chapters", "exercises", "solutions"),
    # The sides: Gazebo's knows nothing of ROS, and nobody but it runs a world.
    "sim/gz": (*ROS, "sim/ros", "sim/bridge", "sim/show"),
    "sim/bridge": ("mujoco", "sim/gz/sim/world", "sim/gz/sim/server", "sim/show"),
    "sim/ros": ("mujoco", "sim/bridge", "sim/show", "sim/gz/sim/world", "sim/gz/sim/server"),
    "sim/show": ("mujoco", "sim/bridge", "sim/gz/sim"),
    "sim/bridge/ros_gz_bridge": ("sim/gz/sim", "sim/ros/launch", "sim/ros/launch_ros", "sim/ros/ros2"),
    "sim/bridge/ros_gz_image": (),
    "sim/bridge/ros_gz_sim": ("sim/bridge/ros_gz_bridge",),
    "sim/gz/msgs": ("sim/gz/sim", "sim/gz/transport", "sim/gz/command"),
    "sim/gz/transport": ("sim/gz/sim", "mujoco"),
    "sim/gz/view": ("sim/gz/sim/world", "sim/gz/sim/server"),
    "sim/ros/cv_bridge": ("cv2",),
    "sim/ros/robot_state_publisher": (),
    "sim/ros/ros_program": ("sim/gz/sim",),
    "grader/feedback": ("rclpy", "mujoco", *RUNNING),
    "grader/score": ("rclpy", "mujoco", *RUNNING),
    "grader/report": ("rclpy", "mujoco", *RUNNING),
    AGENT: ("grader", "mujoco", "rerun"),
}
# Packages that use nothing of `sim` but themselves and these.
USES = {
    "sim/ros/ament_cmake": ("sim/ros/rosidl",),
    "sim/ros/cv_bridge": (),
    "sim/ros/laser_geometry": ("sim/ros/sensor_msgs_py",),
    "sim/ros/launch": (),
    "sim/ros/launch_ros": ("sim/ros/launch",),
    "sim/ros/launch_pytest": ("sim/ros/launch_testing", "sim/ros/launch"),
    "sim/ros/launch_testing": ("sim/ros/launch", "sim/ros/launch_testing_ros/test_runner"),
    "sim/ros/launch_testing_ros": ("sim/ros/launch_testing",),
    "sim/ros/launch_xml": ("sim/ros/launch",),
    "sim/ros/launch_yaml": ("sim/ros/launch",),
    "sim/ros/message_filters": (),
    "sim/ros/nav2_common": ("sim/ros/launch",),
    "sim/ros/prefix": ("sim/ros/launch", "sim/ros/launch_ros", "sim/ros/rosidl"),
    "sim/ros/ros2": (
        *("sim/ros/prefix", "sim/ros/ros_program", "sim/ros/rosbag2", "sim/ros/rosidl_runtime_py"),
        *("sim/ros/launch", "sim/ros/launch_ros", "sim/ros/launch_testing", "sim/ros/launch_testing_ros"),
    ),
    "sim/ros/rosbag2": ("sim/ros/rosidl",),
    "sim/ros/rosbag2_py": ("sim/ros/rosbag2",),
    "sim/ros/rosidl": (),
    "sim/ros/rosidl_runtime_py": (),
    "sim/ros/sensor_msgs_py": (),
    "sim/ros/tf2_geometry_msgs": ("sim/ros/tf2_ros", "sim/ros/tf2_py"),
    "sim/ros/tf2_py": (),
    "sim/ros/tf2_ros": ("sim/ros/tf2_py", "sim/ros/ros_program"),
    "sim/ros/tf_transformations": (),
    "sim/show/rqt_graph": ("sim/ros/ros2", "sim/gz/transport", "sim/show/rviz2/page"),
    "sim/show/rviz2": ("sim/ros/ros_program", "sim/ros/sensor_msgs_py"),
    "sim/show/teleop_twist_keyboard": ("sim/ros/ros_program",),
}
# Packages that work without rclpy.
WITHOUT_ROS = {
    *("ament_cmake", "cv_bridge", "laser_geometry", "launch", "launch_pytest", "launch_testing", "launch_xml"),
    *("launch_yaml", "nav2_common", "prefix", "rosidl", "sensor_msgs_py", "tf_transformations"),
}
# What grades an exercise sees the recording, and nothing of another exercise.
GRADERS = sorted({path.parent.relative_to(ROOT).as_posix() for path in ROOT.glob("exercises/*/grading/*.py")})
FORBIDDEN |= {room: ("rclpy", "mujoco", "chapters", "exercises", "solutions", *RUNNING) for room in GRADERS}
FORBIDDEN |= {
    room: (*FORBIDDEN.get(room, ()), "sim", *(ROS if room.removeprefix("sim/ros/") in WITHOUT_ROS else ()))
    for room in USES
}
# Exceptions: a room may import these, whatever is forbidden above.
ALLOWED = {room: (room, *others) for room, others in USES.items()} | {room: (room,) for room in (AGENT, *GRADERS)}
# What every room may import.
FOR_ALL = (
    *("sim/child_end", "sim/did_you_mean", "sim/error_text", "sim/foreign_variables", "sim/jupyter_proxy"),
    *("sim/machine_clock", "sim/orphan_watch", "sim/page_policy", "sim/postponed_signal", "sim/terminal_text"),
)
# The actions of launch files that a package brings.
ACTIONS = {"sim/bridge/ros_gz_bridge/actions": ("sim/ros/launch", "sim/ros/launch_ros")}
# A module that starts a program and imports how: what the program itself imports is another process.
PROGRAMS = {"grader/run/sandbox/level": "grader/run/sandbox/probe"}
NO_ROS_MESSAGES = ("sim/gz", "grader/feedback", "grader/score", "grader/report", *GRADERS)


@functools.cache
def rooms_of(name):
    return [room for room in FORBIDDEN if below(name, room)]


def is_forbidden(name, imported):
    if below(imported, *PUBLIC_NAMES, *(package.rpartition("/")[2] for package in PACKAGES), "public"):
        return True
    if below(imported, *FOR_ALL) or any(below(name, room) and below(imported, *ACTIONS[room]) for room in ACTIONS):
        return False
    for room in rooms_of(name):
        if below(imported, *FORBIDDEN[room]) and not below(imported, *ALLOWED.get(room, ())):
            return True
    return below(name, *NO_ROS_MESSAGES) and re.match(ROS_MESSAGES, imported) is not None


def nobody_offends(offenders):
    """Fail with every offender, one a line."""
    lines = list(offenders)
    assert not lines, "\n".join(["", *lines])


def test_every_package_is_looked_at():
    assert {f"sim/{package}" for package in PACKAGES} <= set(FORBIDDEN)
    for package in PACKAGES:
        assert any(below(name, f"sim/{package}") for name in modules()), package
    assert [room for room in {*FORBIDDEN, *ALLOWED, *NO_ROS_MESSAGES} if not (ROOT / room).is_dir()] == []


def test_an_import_is_found_however_it_is_written():
    assert place("gz_course.sim.gz.sim.world") == "sim/gz/sim/world"
    assert place("gz_course.grader.score") == "grader/score"
    assert place("rclpy.node") == "rclpy/node"
    assert "grader/errors" in imports("grader/exercise/exercise")
    inside = imports(next(name for name in modules() if name.endswith("/course_agent/rclpy_7_1")))
    assert "rclpy/context" in inside, "imports inside functions count too"
    assert any(below(each, AGENT) for each in inside), "relative imports count too"


def test_no_forbidden_arrow():
    found = [(name, imported) for name in modules() for imported in sorted(imports(name))]
    nobody_offends(f"{name} imports {imported}" for name, imported in found if is_forbidden(name, imported))


def test_a_forbidden_arrow_is_seen():
    for name, imported in [
        ("sim/gz/sim/world", "rclpy/node"),
        ("sim/gz/sim/world", "gz/transport"),
        ("sim/ros/launch/action", "launch"),
        ("grader/grade", "ros_gz_bridge"),
        ("sim/gz/sim/world", "sensor_msgs/msg"),
        ("sim/gz/view/program", "sim/ros/rosidl"),
        ("sim/ros/rosidl/cdr_reader", "sim/show/rviz2"),
        ("sim/bridge/ros_gz_sim/create", "sim/gz/sim/world"),
        ("sim/bridge/ros_gz_bridge/bridge", "mujoco"),
        ("sim/ros/ros2/topic", "sim/gz/transport"),
        ("sim/ros/prefix/local_setup", "rclpy"),
        ("sim/ros/prefix/local_setup", "grader/errors"),
        ("sim/ros/launch/action", "sim/ros/launch_ros/actions"),
        ("grader/score/score", "sim/gz/msgs"),
        ("grader/exercise", "solutions"),
        ("grader/score/score", "exercises/09_closed_loop/grading/wall"),
        ("exercises/09_closed_loop/grading/wall", "exercises/08_sensors/grading/hall"),
        ("exercises/09_closed_loop/grading/wall", "grader/run/run_loop"),
        (f"{AGENT}/course_agent/executor_monitor", "grader/errors"),
    ]:
        assert is_forbidden(name, imported), (name, imported)


def test_one_module_loads_what_grades_the_exercises_and_by_name_only():
    users = {name for name, path in modules().items() if f"{NAMESPACE}exercises" in path.read_text()}
    assert users == {"grader/exercise/grading"}
    assert {name for name in modules() if any(below(each, "runpy") for each in imports(name))} == {
        f"{AGENT}/course_agent/{name}" for name in ("run_node", "tracebacks")
    }


def test_the_simulator_does_not_need_the_view():
    others = (name for name in modules() if below(name, "sim/gz") and not below(name, "sim/gz/view"))
    users = {name for name in others if any(below(each, "sim/gz/view") for each in imports(name))}
    assert users == {"sim/gz/sim/commands/sim"}


def test_one_module_finds_the_nearest_name():
    users = [name for name in modules() if any(below(each, "difflib") for each in imports(name))]
    assert users == ["grader/exercise/solution_diff", "sim/did_you_mean"], "the former prints differences"


def test_no_modules_import_each_other():
    arrows = {name: imports(name, with_types=False, doors=False) & modules().keys() for name in modules()}
    for module, program in PROGRAMS.items():
        arrows[module] -= {program}
    nobody_offends(f"these import each other, directly or not: {', '.join(group)}" for group in cycles(arrows))


def test_a_cycle_is_seen():
    assert cycles({"a": {"b"}, "b": {"c", "d"}, "c": {"a"}, "d": {"e"}, "e": {"d"}, "f": {"a", "e"}}) == [
        ["d", "e"],
        ["a", "b", "c"],
    ]
    assert cycles({"a": {"b", "c"}, "b": {"d"}, "c": {"d"}, "d": set()}) == []


def test_scoring_and_reports_reach_no_running_part_through_others():
    rooms = [name for name in modules() if below(name, "grader/feedback", "grader/score", "grader/report")]
    assert len(rooms) > 10
    found = [(name, other) for name in rooms for other in sorted(reachable(name))]
    nobody_offends(f"{name} reaches {other}" for name, other in found if below(other, *RUNNING))


@functools.cache
def code():
    """Every Python file of ours, submissions that are test cases and what chapter 10 builds aside."""
    return sorted(
        path
        for folder in CODE_FOLDERS
        for path in (ROOT / folder).rglob("*.py")
        if not {"__pycache__", ".ipynb_checkpoints", "turn_ws"} & set(path.parts) and "cases" not in path.parts
    )


def test_no_code_file_is_too_long():
    lengths = {path.relative_to(ROOT): len(path.read_text().splitlines()) for path in code()}
    nobody_offends(f"{name} has {n} lines" for name, n in lengths.items() if n > LONGEST_FILE)


def test_no_file_has_a_vague_name():
    own = (path for path in code() if path.parent != ROOT / "sim/ros/launch_testing/util")  # ROS 2 gave it this name
    nobody_offends(str(path.relative_to(ROOT)) for path in own if VAGUE_NAMES & {path.stem, path.parent.name})


def test_tests_stand_at_the_mirrored_path():
    folders = {path.parent for top in ("sim", "grader") for path in (ROOT / "tests" / top).rglob("test_*.py")}
    places = sorted(folder.relative_to(ROOT / "tests") for folder in folders)
    nobody_offends(f"tests/{place}: there is no {place}" for place in places if not (ROOT / place).is_dir())


def exports(name):
    for node in tree(name).body:
        if isinstance(node, ast.Assign) and any(ast.unparse(t) == "__all__" for t in node.targets):
            return ast.literal_eval(node.value)
    return []


def import_name(name):
    dotted = name.replace("/", ".")
    return f"{NAMESPACE}{dotted}"


def test_every_exported_name_resolves():
    names = [name for name in modules() if exports(name)]
    assert len(names) > 10
    bad = []
    for name in names:
        module = importlib.import_module(import_name(name))
        bad += [f"{name} has no {export}" for export in exports(name) if not hasattr(module, export)]
        bad += [f"{name} exports {export} twice" for export in set(exports(name)) if exports(name).count(export) > 1]
    nobody_offends(bad)


def loaded_by(code, *arguments):
    """Which top-level modules a fresh Python has loaded after some code."""
    program = f"""
import json, re, sys
sys.argv = ["course", *{list(arguments)!r}]
try:
    {code}
except SystemExit:
    pass
finally:
    names = (re.sub(r"^gz_course[.](sim[.]((bridge|ros|show)[.])?)?", "", name) for name in sys.modules)
    print("\\n" + json.dumps(sorted({{name.split(".")[0] for name in names}})))
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=True, cwd=ROOT
    )
    return set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize("package", ["sim.gz.transport", "sim.gz.msgs", "grader"])
def test_an_import_loads_nothing_heavy(package):
    assert loaded_by(f"import {NAMESPACE}{package}") & HEAVY == set()


def test_scoring_loads_neither_ros_nor_the_simulator():
    loaded = loaded_by("import gz_course.grader.grade; from gz_course.grader.score import check; check.check_kinds()")
    assert loaded & {"mujoco", "rclpy", "gz", "ros_gz_bridge"} == set()


@pytest.mark.parametrize("arguments", [["--help"], ["grade", "--help"], ["list"]])
def test_help_and_lists_load_nothing_heavy(arguments):
    loaded = loaded_by("from gz_course.grader.course import main; main()", *arguments)
    assert "grader" in loaded
    assert loaded & (HEAVY | {"numpy", "pyarrow", "gz"}) == set()


def test_every_command_and_check_kind_has_a_file_of_its_own():
    import gz_course.grader.commands as grader_commands
    import gz_course.grader.score.checks as grader_score_checks
    from gz_course.grader.score.check import check_kinds

    assert set(check_kinds()) == {m.name for m in pkgutil.iter_modules(grader_score_checks.__path__)}
    for module in pkgutil.iter_modules(grader_commands.__path__):
        assert hasattr(importlib.import_module(f"gz_course.grader.commands.{module.name}"), "command")


def headings(path):
    """Anchors of a Markdown file, as GitHub makes them."""
    found = [line.lstrip("#").strip() for line in path.read_text().splitlines() if re.match(r"#+ ", line)]
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in found}


TOP_PAGES = [ROOT / name for name in ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md")]
ROOM_PAGES = [path for top in ("sim", "grader", "tests") for path in sorted((ROOT / top).rglob("README.md"))]
PAGES = [path for path in (*TOP_PAGES, *ROOM_PAGES) if "cases" not in path.parts]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_of_the_pages_lead_somewhere(page):
    dead = []
    for target in re.findall(r"\]\(([^)\s]+)(?:\s[^)]*)?\)", page.read_text()):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        there = page.parent / file if file else page
        if not there.exists() or (anchor and there.suffix == ".md" and anchor not in headings(there)):
            dead.append(target)
    assert dead == []
