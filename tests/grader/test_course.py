"""The `course` command: bad usage is one sentence and exit 2, our own faults are exit 3, and an interrupt cleans up."""

import re
import shutil
import signal
import subprocess
import sys
import threading
import time

import pytest

from gz_course.tests.warm_process import WarmPopen

SOLUTION = "solutions/03_teleop/teleop_node.py"
DEADLINE = 120.0


def with_files(folder, root, out="out", report="report.json"):
    return "grade", "03", "--submission", root / SOLUTION, "--out", folder / out, "--json", folder / report


def refused(outcome, *words, code=2):
    assert outcome.code == code, outcome.output
    assert [word for word in words if word not in outcome.words] == [], outcome.output
    assert "Traceback" not in outcome.output and "internal error" not in outcome.output
    assert not list(outcome.folder.rglob("*.rrd"))


def test_without_a_command_it_helps(course):
    outcome = course()
    assert outcome.code == 2
    assert all(command in outcome.output for command in ("grade", "list", "score", "verify"))


def test_help_begins_with_ten_commands_at_most_for_a_student(course):
    outcome = course("--help")
    assert outcome.code == 0
    sections = re.split(r"\n\n(?=[A-Z][a-z ]+:\n)", outcome.stdout.strip())
    titles = [each.partition(":\n")[0] for each in sections[1:]]
    assert titles == ["Options", "Commands", "For a running system", "For instructors"]
    commands = [re.findall(r"^  ([a-z-]+) ", each, re.M) for each in sections[2:]]
    assert len(commands[0]) <= 10 and {"grade", "hint", "list", "show"} <= {*commands[0]}
    assert commands[1] == ["diagnose", "graph", "watch"] and "grade-all" in commands[2]


def test_an_unknown_command(course):
    refused(course("grad", "03"), "grad")


def test_the_list_shows_every_exercise_with_its_points(course):
    outcome = course("list")
    assert outcome.code == 0
    assert re.search(r"03_teleop +100 +- +0/\d +teleop_node.py", outcome.stdout)
    assert "04_lidar_listener" in outcome.stdout


def test_the_list_of_one_exercise_is_its_rubric(course):
    outcome = course("list", "03")
    assert outcome.code == 0
    assert "Velocity commands go to /cmd_vel" in outcome.words and "file: teleop_node.py" in outcome.stdout
    assert re.search(r"20 +Stops and stays stopped +truth/robot/distance reaches 0.5", outcome.stdout)
    assert re.search(r"100 +in all", outcome.stdout)
    refused(course("list", "03_telepo"), "did you mean '03_teleop'?")


def test_trials_that_are_not_there(grade, root):
    refused(grade("03", root / SOLUTION, "--trials", "hiden"), "no file hiden with hidden trials")


def test_an_unknown_exercise_names_the_nearest(grade, root):
    refused(grade("03_telepo", root / SOLUTION), "'03_telepo'", "did you mean '03_teleop'?")


def test_a_missing_file(grade, root):
    refused(
        grade("03", root / "solutions/03_teleop/teleop_nod.py"), "there is no file", "did you mean 'teleop_node.py'?"
    )


def test_a_folder_without_the_file(grade, root):
    refused(grade("03", root / "solutions/04_lidar_listener"), "holds no teleop_node.py")


def test_an_unknown_pace(grade, root):
    refused(grade("03", root / SOLUTION, "--pace", "realtme"), "realtme", "did you mean 'realtime'?")


def test_a_seed_that_is_no_number(grade, root):
    refused(grade("03", root / SOLUTION, "--seed", "lucky"), "--seed", "valid integer")


def test_a_report_that_cannot_be_written_is_said_before_anything_runs(course, tmp_path, root):
    (tmp_path / "file").write_text("")
    refused(course(*with_files(tmp_path, root, report="file/report.json")), "cannot write", "file/report.json")


def test_a_report_on_a_folder(course, tmp_path, root):
    refused(course(*with_files(tmp_path, root, report=".")), "cannot write", str(tmp_path))


def test_a_recording_that_cannot_be_written(course, tmp_path, root):
    (tmp_path / "file").write_text("")
    refused(course(*with_files(tmp_path, root, out="file/out")), "file/out")


def test_a_folder_in_place_of_the_recording(course, tmp_path, root):
    (tmp_path / "out/03_teleop.rrd/x").mkdir(parents=True)
    outcome = course("grade", "03", "--submission", root / SOLUTION, "--out", tmp_path / "out")
    assert outcome.code == 2, outcome.output
    assert "03_teleop.rrd" in outcome.words and "internal error" not in outcome.output


def test_a_course_that_is_nowhere_is_said(course, tmp_path):
    outcome = course("grade", "03", COURSE_ROOT=str(tmp_path / "nowhere"))
    assert outcome.code == 2
    assert "nowhere" in outcome.words


@pytest.mark.parametrize("data", [b"", b"garbage", bytes(range(256)) * 100])
def test_scoring_what_is_no_recording(course, tmp_path, data):
    path = tmp_path / "run.rr"
    path.write_bytes(data)
    outcome = course("score", path)
    assert outcome.code == 2
    assert "run.rr is not a readable recording" in outcome.words


def test_scoring_a_recording_of_something_else(course, tmp_path):
    import rerun as rr

    stream = rr.RecordingStream("other")
    stream.save(tmp_path / "other.rrd")
    stream.log("a", rr.Scalars(1.0))
    stream.disconnect()
    outcome = course("score", tmp_path / "other.rrd")
    assert (outcome.code, "is not a recording of a graded run" in outcome.words) == (2, True), outcome.output


def test_scoring_a_recording_that_lacks_a_fact(course, record, tmp_path):
    """Somebody else's program wrote it, or an older version of this one."""
    made = record({"truth/robot/x": [(0, 0.0)]}, exercise="03_teleop")
    outcome = course("score", made.path)
    assert outcome.code in (1, 2) and "internal error" not in outcome.output, outcome.output


def test_scoring_a_recording_of_an_exercise_that_is_gone(course, record):
    outcome = course("score", record(exercise="77_gone").path)
    refused_words = "no exercise is called '77_gone'"
    assert (outcome.code, refused_words in outcome.words) == (2, True), outcome.output


def spoilt(root, folder, old, new):
    shutil.copytree(root / "exercises", folder / "exercises")
    manifest = folder / "exercises/03_teleop/grading/exercise.toml"
    text = manifest.read_text()
    assert old in text
    manifest.write_text(text.replace(old, new))
    return str(folder)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('file = "teleop', 'flie = "teleop', ["exercise.toml", "file"]),
        pytest.param('bridge = "bridge.yaml"', 'bridge = "bridge.yml"', ["bridge.yml"], marks=pytest.mark.proof),
        pytest.param('world = "lidar_room.sdf"', 'world = "lidar_rom.sdf"', ["lidar_rom.sdf"], marks=pytest.mark.proof),
        pytest.param('robot = "robot"', 'robot = "robbi"', ["robbi", "robot"], marks=pytest.mark.proof),
        ("[run]", '[run]\nobserve = { "/x" = "std_msgs/msg/Flot32" }', ["std_msgs/msg/Flot32"]),
        pytest.param(
            'kind = "change"', 'kind = "chnage"', ["chnage", "did you mean 'change'?"], marks=pytest.mark.proof
        ),
    ],
)
def test_an_exercise_that_is_wrong_is_our_fault_and_says_where(grade, root, tmp_path, old, new, words):
    outcome = grade("03", root / SOLUTION, COURSE_ROOT=spoilt(root, tmp_path / "course", old, new))
    refused(outcome, *words, code=3)


def test_debug_shows_where_an_internal_error_is(course, root):
    prelude = """
import gz_course.grader.exercise as module
def find_exercise(*_):
    raise ZeroDivisionError("planted")
module.find_exercise = find_exercise
"""
    quiet = course("grade", "03", prelude=prelude)
    assert (quiet.code, quiet.stderr) == (3, "course: internal error: ZeroDivisionError: planted\n")
    loud = course("--debug", "grade", "03", prelude=prelude)
    assert "Traceback" in loud.stderr and "planted" in loud.stderr


# A shell's background job ignores SIGINT; the command of a person at a terminal does not.
START = """
import signal, sys
from gz_course.grader.course import main
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.argv.append("--pace=realtime")
main()
"""


class Interrupted:
    """A `course grade` that is stopped by a signal once its submission runs."""

    def __init__(self, root, folder, environment):
        (folder / "node.py").write_text((root / SOLUTION).read_text())
        self.process = WarmPopen(
            [sys.executable, "-c", START, "grade", "03", "--submission", folder / "node.py", "--out", folder / "out"],
            cwd=folder,
            env=environment(folder),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        self.folder = folder
        pause, end = threading.Event(), time.monotonic() + DEADLINE
        while not list(folder.rglob("*.part")):  # a recording is begun when the submission has been started
            assert time.monotonic() < end and self.process.poll() is None
            pause.wait(0.005)


@pytest.mark.parametrize(
    ("number", "code"),
    [
        (signal.SIGINT, 130),
        pytest.param(signal.SIGTERM, 143, marks=pytest.mark.proof),
        pytest.param(signal.SIGHUP, 129, marks=pytest.mark.proof),
    ],
)
def test_an_interrupted_grading_leaves_nothing(root, tmp_path, course_environment, running_in, number, code):
    grading = Interrupted(root, tmp_path, course_environment)
    grading.process.send_signal(number)
    output = grading.process.communicate(timeout=DEADLINE)[0].decode()
    left = running_in(tmp_path)
    for process in left:
        process.kill()
    assert left == []
    assert grading.process.returncode in (code, -number), output
    assert list((tmp_path / "tmp").iterdir()) == []
    assert list(tmp_path.rglob("*.rrd*")) == []
    assert "Traceback" not in output
    assert number != signal.SIGINT or "course: interrupted" in output
