"""A term's exercises go out week by week: only some, no drafts, and what students did stays."""

import shutil

import pytest

from gz_course.grader.course_folder.layout import RELEASED, update, update_from
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.release.choice import chosen
from gz_course.grader.release.student_copy import release

NAMES = ("00_first_run", "03_teleop", "04_lidar_listener")


@pytest.fixture
def course(tmp_path, root):
    """A course with three exercises and their chapters; the programs are those of this checkout."""
    for half in ("exercises", "solutions", "chapters"):
        for name in NAMES:
            shutil.copytree(root / half / name, tmp_path / "course" / half / name)
    return tmp_path / "course"


def draft(course, name):
    manifest = course / "exercises" / name / "grading/exercise.toml"
    manifest.write_text(f"draft = true\n{manifest.read_text()}")


def test_what_a_choice_means(course):
    every = [find_exercise(name, course) for name in NAMES]
    assert chosen("00-03", every) == ["00_first_run", "03_teleop"]
    assert chosen("4, 00", every) == ["00_first_run", "04_lidar_listener"]
    assert chosen("03_teleop", every) == ["03_teleop"]
    for wrong, words in (("07-09", "07-09"), ("03_telepo", "did you mean '03_teleop'"), (",", "names no exercise")):
        with pytest.raises(UsageError, match=words):
            chosen(wrong, every)


def test_drafts_stay_at_home(course, tmp_path):
    draft(course, "04_lidar_listener")
    names, _ = release(course, tmp_path / "student", "00-09")
    assert names == ["00_first_run", "03_teleop"]
    assert not [path for path in (tmp_path / "student").rglob("*04_lidar*")]
    with pytest.raises(UsageError, match="04_lidar_listener is a draft"):
        release(course, tmp_path / "other", "04")
    assert not (tmp_path / "other").exists()


def test_the_second_week_updates_what_the_first_gave_and_touches_no_work(course, tmp_path):
    published, mine = tmp_path / "published", tmp_path / "mine"
    names, changes = release(course, published, "00-03")
    assert names == ["00_first_run", "03_teleop"] and changes is None
    assert exercise_names(published) == names
    shutil.copytree(published, mine)
    begun = mine / "exercises/03_teleop/teleop_node.py"
    begun.write_text("# my work\n")
    (mine / "notes.txt").write_text("mine, too")
    # The second week: another exercise, and a repaired starter and task in an old one.
    for path in ("exercises/03_teleop/teleop_node.py", "exercises/00_first_run/README.md"):
        (course / path).write_text(f"{(course / path).read_text()}\n# repaired\n")
    names, changes = release(course, published, "04")
    assert names == list(NAMES)
    assert "exercises/04_lidar_listener/lidar_listener_node.py" in changes.added or any(
        name.startswith("exercises/04_lidar_listener/") for name in changes.added
    )
    assert "exercises/00_first_run/README.md" in changes.replaced and not changes.removed
    changes = update_from(mine, published)
    assert begun.read_text() == "# my work\n"
    assert changes.kept == {"exercises/03_teleop/teleop_node.py": "exercises/03_teleop/teleop_node.new.py"}
    assert (mine / "notes.txt").read_text() == "mine, too"
    assert "# repaired" in (mine / "exercises/00_first_run/README.md").read_text()
    assert (mine / "chapters/04_lidar_listener").is_dir() and not changes.removed
    assert update_from(mine, published).lines == [], "again changes nothing"


def test_the_record_of_a_release_is_none_for_an_installed_course(course, tmp_path):
    """Else `course update` would take the programs of a copy for files that the course has no more."""
    release(course, tmp_path / "student", "00")
    assert (tmp_path / "student" / RELEASED).is_file()
    with pytest.raises(UsageError, match="was not made by `course init`"):
        update(tmp_path / "student")
