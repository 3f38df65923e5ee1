"""What the tests of whole classes share: a class on disk, and `course grade-all` as a process of its own."""

import dataclasses
import shutil
from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise


@pytest.fixture(scope="session")
def exercise(root):
    return find_exercise("03_teleop", root)


@pytest.fixture(scope="session")
def solved(root):
    return (root / "solutions/03_teleop/teleop_node.py").read_bytes()


@pytest.fixture
def hand_in(tmp_path):
    """Write files, by their names below a class's folder; returns that folder."""

    def write_all(files: dict[str, bytes], name="class"):
        folder = tmp_path / name
        for inside, data in files.items():
            path = folder / inside
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return folder

    return write_all


@pytest.fixture(scope="session")
def short_course(root, tmp_path_factory):
    """A course whose teleop exercise lasts half a second, for tests that need many gradings and no full marks."""
    folder = tmp_path_factory.mktemp("short") / "course"
    copy = folder / "exercises/03_teleop"
    shutil.copytree(root / "exercises/03_teleop", copy)
    manifest = copy / "grading/exercise.toml"
    lines = manifest.read_text().splitlines()
    manifest.write_text("\n".join("duration = 0.5" if line.startswith("duration = ") else line for line in lines))
    return folder


@dataclasses.dataclass
class ClassFolder:
    """What a run left: the gradebook, and each student's folder."""

    path: Path

    @property
    def gradebook(self):
        return (self.path / "gradebook.csv").read_bytes()

    @property
    def journal(self):
        return self.path / "journal.jsonl"


@pytest.fixture
def class_folder():
    return ClassFolder
