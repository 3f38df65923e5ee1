"""The autograder in a minimal Debian, with everything where Gradescope puts it: built once, then graded.

Source: Gradescope, "Autograder Specifications" and "Submission Metadata", https://gradescope-autograders.readthedocs.io
"""

import json
import shutil
import zipfile

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.package.gradescope import package
from gz_course.tests.grader.package.minimal_root import make

pytestmark = [pytest.mark.proof, pytest.mark.timeout(3600)]

FILE = "teleop_node.py"
# Writes results wherever it may, ends its parent and all other processes, and leaves one behind that writes later.
HOSTILE = b"""
import glob, json, os, signal, subprocess
full = json.dumps({"score": 100, "output": "perfect"})
for path in ["/autograder/results/results.json", "/autograder/run_autograder", *glob.glob("/tmp/*/results.json")]:
    try:
        open(path, "w").write(full)
    except OSError:
        pass
late = "while :; do echo '%s' > /autograder/results/results.json; done" % full
subprocess.Popen(["sh", "-c", late], start_new_session=True, stderr=subprocess.DEVNULL)
for target in (os.getppid(), 1, -1):
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.kill(target, number)
        except OSError:
            pass
os.kill(os.getpid(), signal.SIGKILL)
"""
METADATA = {
    "id": 123456,
    "created_at": "2026-11-01T14:22:32.365935-07:00",
    "assignment": {"due_date": "2026-11-10T23:00:00.000000-08:00", "title": "Teleop", "total_points": "100.0"},
    "submission_method": "upload",
    "users": [{"email": "student@example.com", "id": 1234, "name": "Student User"}],
    "previous_submissions": [],
}


class Autograder:
    """`/autograder` in the minimal root."""

    def __init__(self, root, exercises):
        self.root, self.exercises = root, exercises
        self.folder = root.folder / "autograder"
        self.packaged = None

    def unpack(self, exercise, demand="B"):
        """Put the zip of an exercise where the image has it. The unpacker gives no file the right to be run."""
        if self.packaged == (exercise, demand):
            return
        shutil.rmtree(self.folder / "source", ignore_errors=True)
        archive = self.root.folder / "autograder.zip"
        package(find_exercise(exercise, self.exercises), archive, demand=demand)
        with zipfile.ZipFile(archive) as packed:
            packed.extractall(self.folder / "source")
        shutil.copy(self.folder / "source/run_autograder", self.folder / "run_autograder")
        (self.folder / "run_autograder").chmod(0o755)
        self.packaged = exercise, demand

    def build(self):
        done = self.root.run("bash", "/autograder/source/setup.sh", timeout=1800)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]

    def grade(self, files, exercise="03_teleop", demand="B", **how):
        """Grade files as Gradescope does; return the results."""
        self.unpack(exercise, demand)
        for name in ("submission", "results"):
            shutil.rmtree(self.folder / name, ignore_errors=True)
            (self.folder / name).mkdir()
        (self.folder / "submission_metadata.json").write_text(json.dumps(METADATA))
        for name, data in files.items():
            path = self.folder / "submission" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        program = (self.folder / "run_autograder").read_bytes()
        done = self.root.run("sh", "-c", "cd /autograder && ./run_autograder", **how)
        assert done.returncode == 0, done.stderr
        assert (self.folder / "run_autograder").read_bytes() == program
        results = json.loads((self.folder / "results/results.json").read_text())
        assert isinstance(results["score"], int | float) and isinstance(results["output"], str)
        assert results["score"] == sum(test["score"] for test in results.get("tests", ()))
        return results


@pytest.fixture(scope="module")
def autograder(tmp_path_factory, root):
    made = Autograder(make(tmp_path_factory.mktemp("minimal")), root)
    made.unpack("03_teleop")
    made.build()
    return made


def files_of(folder, exercise):
    return {name: (folder / name).read_bytes() for name in exercise.parts}


@pytest.mark.parametrize("name", ["03_teleop", "06_spawn", "10_actions"])
def test_a_solution_of_one_file_of_several_and_of_a_package(autograder, root, name):
    exercise = find_exercise(name, root)
    results = autograder.grade(files_of(root / "solutions" / name, exercise), name)
    assert results["score"] == exercise.max_score, results["output"]
    assert results["extra_data"]["sandbox"] in "AB"


def test_a_wrong_one_and_one_with_more_files(autograder, root):
    solved = (root / "solutions/03_teleop" / FILE).read_bytes()
    wrong = autograder.grade({FILE: (root / "solutions/03_teleop/rejected/never_stops" / FILE).read_bytes()})
    assert 0 < wrong["score"] < 100 and "drives on" in wrong["output"]
    assert autograder.grade({FILE: solved, "own.py": b"x = 1", "notes ü.txt": b"", ".git/config": b""})["score"] == 100


@pytest.mark.parametrize(
    ("files", "words"),
    [({}, "holds no"), ({"a.py": b"", "b.py": b""}, "a.py, b.py"), ({FILE: b"x = ("}, "SyntaxError")],
    ids=["empty", "no file of the name", "no Python"],
)
def test_what_cannot_be_run(autograder, files, words):
    results = autograder.grade(files)
    assert results["score"] == 0 and words in results["output"]


@pytest.mark.parametrize("contained", [False, True], ids=["level B", "level C, as in Docker"])
def test_a_hostile_one(autograder, contained):
    results = autograder.grade({FILE: HOSTILE}, demand="C" if contained else "B", contained=contained)
    assert results["score"] == 0 and results["extra_data"]["outcome"] != "graded", results["output"]


def test_with_the_rights_of_docker_it_grades_at_level_c_or_not_at_all(autograder, root):
    solved = {FILE: (root / "solutions/03_teleop" / FILE).read_bytes()}
    refused = autograder.grade(solved, contained=True)
    assert refused["extra_data"]["outcome"] == "infra" and "not your fault" in refused["output"]
    results = autograder.grade(solved, demand="C", contained=True)
    assert (results["score"], results["extra_data"]["sandbox"]) == (100, "C")
