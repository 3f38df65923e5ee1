"""`course new`: a name that fits and is free gives an exercise that verifies as it is; any other gives one sentence."""

import shutil
import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.scaffold.exercise import DEFECTS, NAME, check_name, contents, planted, scaffold
from gz_course.grader.verify import FEWEST_ACCEPTED, FEWEST_REJECTED, variants

NEW = "07_follow_the_wall"


def files_below(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


@pytest.mark.proof
def test_a_new_exercise_verifies_as_it_is(tmp_path, course, clean):
    root = tmp_path / "course"
    root.mkdir()
    made = course("new", NEW, COURSE_ROOT=str(root))
    assert made.code == 0, made.output
    assert [line for line in made.stdout.splitlines() if line.startswith("exercises/")] == [
        f"exercises/{NEW}/{name}"
        for name in ("README.md", "grading/exercise.toml", "bridge.yaml", "follow_the_wall_node.py")
    ]
    assert all(name in made.stdout for name in files_below(root))
    outcome = course("verify", NEW, COURSE_ROOT=str(root))
    clean(outcome)
    assert outcome.code == 0, outcome.output
    assert "starter x x x 0/100" in outcome.words and "solution . . . 100/100" in outcome.words
    assert outcome.words.count("WRONG") == 0


def test_both_halves_fit_together(tmp_path):
    made = scaffold(NEW, tmp_path)
    assert sorted(str(path.relative_to(tmp_path)) for path in made) == files_below(tmp_path)
    exercise = find_exercise("07", tmp_path)
    declared = variants(exercise)
    names = [variant.name for variant in declared]
    assert exercise.title == "Follow the wall" and exercise.max_score == 100
    assert sum(name.startswith("accepted/") for name in names) >= FEWEST_ACCEPTED
    assert sum(name.startswith("rejected/") for name in names) >= FEWEST_REJECTED
    for variant in declared:
        compile((variant.folder / exercise.file).read_text(), variant.name, "exec")
        assert "@" not in (variant.folder / exercise.file).read_text()
    # The manifest explains itself: comments for its author.
    assert exercise.manifest.read_text().count("#") > 5
    assert exercise.bridge.is_file()


def test_each_rejected_variant_has_one_defect():
    _, private = contents(NEW)
    solution = private["follow_the_wall_node.py"].splitlines()
    for fault in DEFECTS:
        wrong = private[f"rejected/{fault}/follow_the_wall_node.py"].splitlines()
        assert len(wrong) == len(solution)
        assert sum(a != b for a, b in zip(wrong, solution, strict=True)) == 1, fault
    with pytest.raises(ValueError, match="exactly once"):
        planted("twice twice", "twice", "once")


BAD = [
    "",
    "7_x",
    "07",
    "07_",
    "07-x",
    "07_X",
    "07_x y",
    "../07_x",
    "07_x/..",
    "07_é",
    "07__x",
    "٠٧_x",
    "07_x\n",
    "07_" + "x" * 99,
]


@pytest.mark.parametrize("name", BAD)
def test_bad_names(tmp_path, name):
    with pytest.raises(UsageError, match="is no name for an exercise: two digits"):
        scaffold(name, tmp_path)
    assert list(tmp_path.iterdir()) == []


@given(st.text(max_size=12) | st.from_regex(NAME, fullmatch=True))
def test_a_name_is_refused_or_one_folder(name):
    with tempfile.TemporaryDirectory() as folder:
        try:
            check_name(name, Path(folder))
        except UsageError as error:
            assert "\n" not in str(error)
        else:
            assert Path(name).name == name and name.isascii() and name[:2].isdigit()


@pytest.mark.parametrize("half", ["exercises", "solutions"])
def test_a_name_that_exists_in_either_half(tmp_path, half):
    (tmp_path / half / NEW).mkdir(parents=True)
    (tmp_path / half / NEW / "mine.py").write_text("work")
    with pytest.raises(UsageError, match=f"there is already {half}/{NEW}"):
        scaffold(NEW, tmp_path)
    assert files_below(tmp_path) == [f"{half}/{NEW}/mine.py"]


def test_a_number_that_is_taken(tmp_path):
    scaffold(NEW, tmp_path)
    before = files_below(tmp_path)
    with pytest.raises(UsageError, match=f"number 07 is that of {NEW}; the next free one is 08"):
        scaffold("07_other", tmp_path)
    assert files_below(tmp_path) == before


def test_what_cannot_be_written_leaves_nothing(tmp_path, course):
    (tmp_path / "solutions").write_text("in the way")
    outcome = course("new", NEW, COURSE_ROOT=str(tmp_path))
    assert outcome.code == 2 and "cannot write" in outcome.output and "solutions" in outcome.output
    assert len(outcome.stderr.splitlines()) == 1
    assert not (tmp_path / "exercises" / NEW).exists() and (tmp_path / "solutions").read_text() == "in the way"


def test_a_course_that_is_nowhere(tmp_path):
    with pytest.raises(UsageError, match="COURSE_ROOT"):
        scaffold(NEW, tmp_path / "nowhere")


def test_a_second_exercise_gets_the_next_number(tmp_path, root):
    shutil.copytree(root / "exercises/03_teleop", tmp_path / "exercises/03_teleop")
    with pytest.raises(UsageError, match="04_wall_follower"):
        scaffold("next", tmp_path)
