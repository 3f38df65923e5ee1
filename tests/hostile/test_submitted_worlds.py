"""Launch files whose worlds and models mean harm: nothing they name is opened outside the box, nothing runs there."""

import json
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade
from gz_course.grader.record.reading import Recording
from gz_course.grader.run import watchdog
from gz_course.grader.run.sandbox.probe import try_level

ROOT = Path(__file__).parents[2]
LAUNCH = """
import sys
from pathlib import Path
from launch import LaunchDescription
from launch.actions import ExecuteProcess
HERE = Path(__file__).parent
def generate_launch_description():
    attack = ExecuteProcess(cmd=[sys.executable, str(HERE / "attack.py")], output="screen")
    simulator = ExecuteProcess(cmd=["gz", "sim", "-s", "-r", str(HERE / "mine.sdf")], output="screen")
    return LaunchDescription([simulator, attack])
"""
# xacro looks at the names an expression uses, but not at those inside a lambda.
SHELL = (
    "${(lambda: [c for c in ().__class__.__base__.__subclasses__() if c.__name__ == '_wrap_close'][0]"
    ".__init__.__globals__['system']('COMMAND'))()}"
)
XACRO = (
    """<sdf version="1.9" xmlns:xacro="http://ros.org/wiki/xacro"><model name="m{}"><static>1</static>"""
    """<link name="l"/></model></sdf>"""
)
MODEL = "<sdf version='1.9'><model name='{}'><static>1</static><link name='l'/></model></sdf>"
WORLD = "<sdf version='1.9'><world name='mine'>{}</world></sdf>"
# Talks to the grader itself, past the programs that would look at the file first.
ATTACK = """
import base64
from course_agent.grader_requests import ask, hear
from course_agent.channel import channel
from gz.msgs.entity_factory_pb2 import EntityFactory
channel().listen(hear)
print("ESCAPED" if ask({"worlds": True}).get("worlds") else "held worlds", flush=True)
def create(**what):
    data = base64.b64encode(EntityFactory(**what).SerializeToString()).decode()
    answer = ask({"call": {"verb": "create", "type": "gz.msgs.EntityFactory", "data": data}})
    print("ESCAPED" if answer.get("done") else "held", sorted(what), answer, flush=True)
create(sdf_filename=SECRET)
create(sdf_filename=SECRET + ".xacro")
create(sdf=f"<sdf version='1.9'><include><uri >{SECRET}</uri ></include></sdf>")
create(sdf=f"<sdf version='1.9'><include><uri >{SECRET}.xacro</uri ></include></sdf>")
print("done", flush=True)
"""
BODY = (
    "<model name='b{0}'><pose>{1} {2} {3} 0 0 0</pose><link name='l'><collision name='c'><geometry><box><size>1 1 1"
    "</size></box></geometry></collision></link></model>"
)


def processes():
    return {each.pid for each in psutil.Process().children(recursive=True)}


@pytest.fixture
def submission(tmp_path):
    """Write a submission; the folder."""

    def write(**files):
        folder = tmp_path / "submission"
        folder.mkdir()
        for name, text in {"bringup.launch.py": LAUNCH, "attack.py": "", **files}.items():
            (folder / name.replace("_dot_", ".")).write_text(text)
        return folder

    return write


@pytest.mark.proof
@pytest.mark.parametrize("level", "ABC")
def test_no_file_is_opened_and_no_code_is_run_outside_the_box(level, submission, tmp_path):
    if lack := try_level(level):
        pytest.skip(f"no level {level} here: {lack}")
    secret, ran = tmp_path / "secret.sdf", tmp_path / "ran"
    tmp_path.chmod(0o755)
    payload = XACRO.format(SHELL.replace("COMMAND", f"touch {ran}"))
    secret.write_text(MODEL.format("stolen"))
    (tmp_path / "secret.sdf.xacro").write_text(payload)
    folder = submission(
        mine_dot_sdf=WORLD.format("<include><uri >payload.sdf.xacro</uri ></include>"),
        payload_dot_sdf_dot_xacro=payload,
        **{"attack_dot_py": f"SECRET = {str(secret)!r}{ATTACK}"},
    )
    report = tmp_path / "report.json"
    command = [sys.executable, "-m", "gz_course.grader.course", "grade", "02_launch", "--submission", str(folder)]
    command += ["--sandbox", level, "--out", str(tmp_path / "out"), "--json", str(report)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    assert not ran.exists()
    for trial in json.loads(report.read_text())["trials"]:
        recording = Recording(Path(trial["recording"]))
        log = "\n".join(line.text for line in recording.lines("log/student"))
        assert "ESCAPED" not in log and "create: done" not in recording.facts()["launch"]["calls"], log
        assert not recording.has("truth/stolen/x") and "stolen" not in log
        assert "held" in log and "done" in log, log


@pytest.mark.proof
@pytest.mark.parametrize(
    ("world", "outcome", "words"),
    [
        pytest.param(
            WORLD.format("".join(BODY.format(i, i % 10, i // 10 % 10, i // 100) for i in range(5000))),
            "timeout",
            "too many bodies",
            id="5000 bodies",
        ),
    ],
)
def test_a_world_that_is_too_much_is_the_submissions_loss(submission, tmp_path, monkeypatch, world, outcome, words):
    monkeypatch.setattr(watchdog, "CPU_SECONDS", 12.0)
    monkeypatch.setattr(watchdog, "CPU_FACTOR", 0.0)
    before = processes()
    folder = submission(mine_dot_sdf=world)
    exercise = find_exercise("02_launch", ROOT)
    report = grade(exercise, folder, tmp_path / "out", trials=exercise.trials[:1])
    assert (report.score.outcome, report.score.points) == (outcome, 0)
    assert words in report.score.diagnosis
    assert processes() - before == set()
