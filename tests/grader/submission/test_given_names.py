"""Files that come under other names than the exercise asks for: taken, and said."""

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.submission.archive import Member
from gz_course.grader.submission.intake import select, take_in


@pytest.fixture(scope="module")
def teleop(root):
    return find_exercise("03_teleop", root)


@pytest.fixture(scope="module")
def convoy(root):
    return find_exercise("11_many_robots", root)


def tree(*names):
    return {name: Member(len(name), lambda most, name=name: name.encode()[:most]) for name in names}


def taken(exercise, *names, **options):
    """Return name -> the name under which it was handed in, and the notes."""
    chosen = select(tree(*names), exercise, "jane", **options)
    assert chosen.main in chosen.files
    return {name: content.decode() for name, content in chosen.files.items()}, list(chosen.notes)


@pytest.mark.parametrize(
    "given",
    ["teleop_node-2.py", "teleop_node (1).py", "teleop_node.PY", "Teleop_Node.py", "teleop_node.py.txt",
     "teleop_node-1.PY.TXT", "week 3/teleop_node-1.py"],
)  # fmt: skip
def test_a_file_of_a_changed_name_is_the_file(teleop, given):
    files, notes = taken(teleop, given, "week 3/other.py", "other.py")
    assert files["teleop_node.py"] == given
    assert len(notes) == 1 and given in notes[0] and "is taken as" in notes[0]


def test_the_right_name_needs_no_note(teleop, convoy):
    assert taken(teleop, "teleop_node.py", "speeds.py", "notes.txt", "a-1.py")[1] == []
    assert taken(convoy, "convoy.launch.py", "follower_node.py")[1] == []


def test_every_file_of_an_exercise_has_a_number(convoy):
    files, notes = taken(convoy, "convoy.launch-1.py", "follower_node-1.py", "gains-1.py", "data-1.csv")
    assert files == {
        "convoy.launch.py": "convoy.launch-1.py",
        "follower_node.py": "follower_node-1.py",
        "gains.py": "gains-1.py",
        "data-1.csv": "data-1.csv",
    }
    assert len(notes) == 3


def test_two_files_for_one_name_are_not_guessed_between(teleop):
    with pytest.raises(
        UsageError, match=r"jane holds teleop_node.py 2 times: teleop_node-1.py, teleop_node-2.py; keep"
    ):
        taken(teleop, "teleop_node-1.py", "teleop_node-2.py")


def test_what_is_there_twice_is_said(teleop, convoy):
    files, notes = taken(teleop, "teleop_node.py", "old/teleop_node.py", "teleop_node-1.py")
    assert files["teleop_node.py"] == "teleop_node.py"
    assert notes == [
        "teleop_node.py is graded, and teleop_node-1.py beside it is not.",
        "teleop_node.py is there twice: teleop_node.py is graded, old/teleop_node.py is not.",
    ]
    _, notes = taken(convoy, "a/convoy.launch.py", "a/follower_node.py", "b/follower_node.py", "c/follower_node.py")
    told = "follower_node.py is there 3 times: a/follower_node.py is graded, b/follower_node.py and 1 more are not."
    assert notes == [told]


def test_variants_beside_a_solution_are_no_copies(teleop):
    assert taken(teleop, "teleop_node.py", "accepted/a/teleop_node.py", "rejected/b/teleop_node.py")[1] == []


def test_other_exercises_of_a_copy_of_the_course_are_no_copies(root):
    exercise = find_exercise("05_yaml_bridge", root)
    names = [f"lab/exercises/{name}/bridge.yaml" for name in ("03_teleop", "05_yaml_bridge", "08_sensors")]
    assert taken(exercise, *names) == ({"bridge.yaml": names[1]}, [])
    assert "is there twice" in taken(exercise, *names, "lab/exercises/05_yaml_bridge/old/bridge.yaml")[1][0]


def test_one_file_of_any_name_is_the_file(teleop, convoy):
    files, notes = taken(teleop, "robot.py.txt", "notes.txt")
    assert files == {"robot.py": "robot.py.txt", "notes.txt": "notes.txt"}
    assert notes[1] == "There is no teleop_node.py; robot.py, the only file of its kind, is taken for it."
    files, notes = taken(convoy, "my.launch.py", "follower_node.py")
    assert set(files) == {"my.launch.py", "follower_node.py"} and "There is no convoy.launch.py" in notes[0]
    assert taken(teleop, "jane.py", own_name=True) == ({"jane.py": "jane.py"}, [])


@pytest.mark.parametrize("name", ["robot.PY", "robot.py.txt"])
def test_a_single_file_that_is_named_runs_as_python(teleop, tmp_path, name):
    (tmp_path / name).write_text("x = 1\n")
    submission = take_in(teleop, tmp_path / name)
    assert (submission.main, submission.files) == ("robot.py", {"robot.py": b"x = 1\n"})
    assert submission.notes == (f"{name} is taken as robot.py.",)
