"""`course init` and `course update`: the course in a folder, newer chapters, and a student's work that stays."""

import json
import shutil

import pytest

from gz_course.grader.course_folder import layout
from gz_course.grader.course_folder.layout import RECORD, lay_out, update
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.pristine import put_back

STARTER = "exercises/03_teleop/teleop_node.py"
CHAPTER = "chapters/03_teleop/03_teleop.ipynb"
BRIDGE = "exercises/03_teleop/bridge.yaml"


@pytest.fixture
def released(root, tmp_path, monkeypatch):
    """A small course that newer versions can be made of."""
    source = tmp_path / "released"
    for part in ("exercises", "chapters"):
        shutil.copytree(root / part / "03_teleop", source / part / "03_teleop")
    (source / "chapters/README.md").write_text("for authors")
    monkeypatch.setattr(layout, "material", lambda: source)
    return source


@pytest.fixture
def mine(released, tmp_path):
    lay_out(tmp_path / "mine")
    return tmp_path / "mine"


def test_all_is_there_but_nothing_for_authors(mine):
    assert "`exercises/03_teleop/teleop_node.py`" in (mine / "README.md").read_text()
    assert (mine / CHAPTER).is_file() and not (mine / "chapters/README.md").exists()
    assert not (mine / "solutions").exists()
    assert {path.name for path in (mine / "exercises/03_teleop").iterdir()} == {
        "README.md",
        "bridge.yaml",
        "teleop_node.py",
    }


def test_newer_files_come_and_own_work_stays(mine, released):
    (mine / STARTER).write_text("my work")
    notebook = json.loads((mine / CHAPTER).read_text())
    code = next(cell for cell in notebook["cells"] if cell["cell_type"] == "code")
    code["outputs"] = [{"output_type": "stream", "name": "stdout", "text": "ran"}]
    (mine / CHAPTER).write_text(json.dumps(notebook))
    for name in (STARTER, CHAPTER, BRIDGE):
        (released / name).write_text((released / name).read_text().replace("robot", "droid"))
    (released / "chapters/03_teleop/more.svg").write_text("<svg/>")
    (released / "chapters/03_teleop/three_programs.svg").unlink()
    changes = update(mine)
    assert set(changes.replaced) >= {CHAPTER, BRIDGE}
    assert changes.added == ["chapters/03_teleop/more.svg"]
    assert changes.removed == ["chapters/03_teleop/three_programs.svg"]
    assert changes.kept == {STARTER: "exercises/03_teleop/teleop_node.new.py"}
    assert (mine / STARTER).read_text() == "my work"
    assert update(mine) == layout.Changes(), "a second update changes nothing"
    put_back(find_exercise("03", mine), mine / "runs")
    assert "droid" in (mine / STARTER).read_text(), "the newest starter"


def test_a_file_that_the_student_removed_stays_away(mine):
    (mine / CHAPTER).unlink()
    assert update(mine) == layout.Changes()
    assert not (mine / CHAPTER).exists()


def test_an_update_that_was_interrupted_is_completed(mine, released):
    (released / BRIDGE).write_text("[]\n")
    (mine / BRIDGE).write_text("[]\n")  # written, but not yet in the record
    assert update(mine) == layout.Changes()
    (released / BRIDGE).write_text("- {}\n")
    assert update(mine).replaced == [BRIDGE]


def test_a_folder_that_is_used_is_refused_and_stays(mine, tmp_path):
    with pytest.raises(UsageError, match=r"not empty; .*`course update`"):
        lay_out(mine)
    (tmp_path / "file").write_text("x")
    with pytest.raises(UsageError, match="is a file"):
        lay_out(tmp_path / "file")


def test_a_checkout_brings_solutions_and_an_installation_has_none(released, tmp_path):
    with pytest.raises(UsageError, match="an installed course has no solutions"):
        lay_out(tmp_path / "mine", solutions=True)
    assert not (tmp_path / "mine").exists()
    (released / "solutions/03_teleop").mkdir(parents=True)
    (released / "solutions/03_teleop/teleop_node.py").write_text("solved")
    lay_out(tmp_path / "mine", solutions=True)
    assert (tmp_path / "mine/solutions/03_teleop/teleop_node.py").read_text() == "solved"


@pytest.mark.parametrize(
    ("record", "words"),
    [
        (None, "was not made by `course init`"),
        ("{", "cannot be read"),
        ('{"version": "0.1.0", "files": {"a": 3}}', "cannot be read"),
        ('{"version": "99.0", "files": {}}', r"made by version 99\.0.*pip install --upgrade"),
    ],
)
def test_a_folder_of_another_kind_is_refused(mine, record, words):
    (mine / RECORD).unlink() if record is None else (mine / RECORD).write_text(record)
    with pytest.raises(UsageError, match=words):
        update(mine)


def test_a_record_cannot_name_files_outside(mine, tmp_path):
    (tmp_path / "precious").write_text("x")
    record = json.loads((mine / RECORD).read_text())
    record["files"]["../precious"] = "2d711642b726b04401627ca9fbac32f5c8530fb1903cc4db02258717921a4881"
    (mine / RECORD).write_text(json.dumps(record))
    update(mine)
    assert (tmp_path / "precious").is_file()
