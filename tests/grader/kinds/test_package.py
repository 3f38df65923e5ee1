"""A node with its package of interfaces: what is started, and what a package with a fault is told."""

import json
import shutil

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.kinds.given_node import APART
from gz_course.grader.kinds.package import command, misdirected, plan
from gz_course.grader.run.agent.course_agent.run_package import build_all
from gz_course.grader.submission.intake import take_in

PACKAGE = "patrol_interfaces"


@pytest.fixture
def solved(root, tmp_path):
    """A copy of the solution that may be spoiled."""
    parts = shutil.ignore_patterns("accepted", "rejected", "*.toml")
    return shutil.copytree(root / "solutions" / "10_actions", tmp_path / "handed_in", ignore=parts)


def test_the_exercises_node_lies_in_a_sandbox_of_its_own_where_no_file_of_a_submission_can(root, solved):
    exercise = find_exercise("10_actions", root)
    (solved / "given_node.py").write_text("raise SystemExit")
    found = plan(exercise, take_in(exercise, solved))
    assert found.program == "patrol_server.py"
    assert found.beside[f"{APART}/given_node.py"] == (exercise.grading / "given_node.py").read_bytes()
    assert not any(name.startswith(APART) for name in found.files)
    assert f"{PACKAGE}/action/Patrol.action" in found.files.keys() & found.beside.keys()
    assert "patrol_server.py" not in found.beside


def test_only_its_own_parameters_stand_in_the_command_line_of_the_students_node(tmp_path):
    given = {"server": {"max_speed": 0.3}, "client": {"too_fast": 0.4}}
    *_, program, words = command(tmp_path / "patrol_server.py", Trial("some", 0, parameters=given))
    assert (program, json.loads(words)) == (str(tmp_path / "patrol_server.py"), given["server"])


def test_a_fault_in_the_package_is_one_sentence_with_file_and_line(solved, tmp_path):
    def faults(file, old, new):
        path = solved / PACKAGE / file
        text = path.read_text()
        path.write_text(text.replace(old, new))
        found = build_all(solved, tmp_path / "install")
        path.write_text(text)
        return "\n".join(found)

    assert faults("package.xml", "", "") == ""
    assert (tmp_path / "install" / "share" / PACKAGE / "action" / "Patrol.action").is_file()
    action, lists = "action/Patrol.action", "CMakeLists.txt"
    assert faults(action, "geometry_msgs/", "geometry_msg/").startswith(f"{PACKAGE}/{action}:2: unknown package")
    assert "did you mean 'float64'?" in faults(action, "float64 speed", "float46 speed")
    assert "is not a dependency" in faults(lists, "  DEPENDENCIES geometry_msgs\n", "")
    assert "member_of_group" in faults(
        "package.xml", "<member_of_group>rosidl_interface_packages</member_of_group>", ""
    )
    assert "this is not XML" in faults("package.xml", "</package>", "")


def test_a_subscription_that_gets_nothing_by_its_durability_is_named():
    end = {"kind": "subscription", "node": "/patrol_server", "topic": "/odom", "type": "nav_msgs/msg/Odometry"}
    end |= {"reliability": "RELIABLE", "durability": "VOLATILE"}
    facts = {"offered": {"/odom": end["type"]}, "endpoints": [end]}
    assert misdirected(None, facts) == ""
    end["durability"] = "TRANSIENT_LOCAL"
    assert "asks for the durability TRANSIENT_LOCAL" in misdirected(None, facts)
