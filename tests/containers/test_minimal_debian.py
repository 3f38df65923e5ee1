"""On a minimal Debian the README's commands work, and the steps of the container files.

An ordinary user without user namespaces; a home that nobody can write to; a path with blanks and umlauts.
"""

import subprocess
from pathlib import Path

import pytest

from gz_course.tests.containers.image_build import build, context
from gz_course.tests.containers.minimal_root import Layer, debian, why_not

ROOT = Path(__file__).parents[2]
HOME = "/home/student"
PLACE = f"{HOME}/Kürs mit Blank/course"
LARGEST = 700  # [MB] of what grading needs

pytestmark = [
    pytest.mark.proof,
    pytest.mark.timeout(3600),
    pytest.mark.skipif(bool(why_not()), reason=why_not() or "it can be made"),
]


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    temporary = tmp_path_factory.getbasetemp()
    shared = temporary.parent if temporary.name.startswith("popen-") else temporary  # the workers of xdist share one
    try:
        return debian(shared / "minimal debian")
    except subprocess.CalledProcessError as error:
        pytest.skip(f"debootstrap has failed: {(error.stdout or error.stderr).strip().splitlines()[-1:]}")


def clone(layer: Layer) -> None:
    """Put a clone of this checkout into the layer, in a home that the user cannot write to."""
    assert layer.run(["useradd", "-m", "-u", "1000", "student"], user=0).returncode == 0
    subprocess.run(["git", "clone", "-q", ROOT, f"{layer.upper}{PLACE}"], check=True)
    assert layer.run(["sh", "-c", f"chown -R student: {HOME}; chmod a-w {HOME}"], user=0).returncode == 0


def run(layer: Layer, command: str) -> str:
    done = layer.run(["sh", "-c", f'cd "{PLACE}" && {command}'])
    assert done.returncode == 0, done.stdout[-5000:]
    return done.stdout


def test_the_commands_of_the_readme(base: Path, tmp_path: Path) -> None:
    layer = Layer(tmp_path / "user", [base])
    clone(layer)
    assert layer.run(["sh", "-c", "unshare --user true"]).returncode != 0, "no user namespaces"
    told = run(layer, "make demo")
    assert told.count("score: 100 of 100") == 2, told[-3000:]
    # The tests of the rooms that know most about the machine, in place of all.
    rooms = "tests/sim/test_machine.py tests/sim/ros/prefix tests/sim/ros/ros2/test_run.py tests/grader/process"
    told = run(layer, f"make .venv/with-tools && .venv/bin/pytest -q -m 'not proof' {rooms}")
    assert " passed" in told and " failed" not in told


def test_the_steps_of_the_dev_container(base: Path, tmp_path: Path) -> None:
    layer = Layer(tmp_path / "user", [base])
    clone(layer)
    run(layer, "bash .devcontainer/create.sh && . .venv/bin/activate && course list")
    told = run(
        layer, "HOME=/tmp bash .devcontainer/attach.sh --version && .venv/bin/jupyter server extension list 2>&1"
    )
    assert "jupyter_server_proxy" in told


def test_the_steps_of_the_dockerfile(base: Path, tmp_path: Path) -> None:
    files = context(ROOT, tmp_path / "context")
    stages = build((ROOT / "Dockerfile").read_text(), files, base, tmp_path)
    grader = stages["grader"]
    size = int(grader.run("du -sm /opt/course").split()[0])
    assert size <= LARGEST
    told = grader.run(
        "course grade 03_teleop --submission /given/teleop_node.py --out /tmp/runs",
        network=False,
        given=ROOT / "solutions/03_teleop",
    )
    assert "score: 100 of 100" in told
    course = stages["course"]
    assert course.command[:2] == ["jupyter", "lab"]
    assert "jupyter_server_proxy" in course.run("jupyter server extension list 2>&1", network=False)
    assert course.run("id -u; ls exercises").startswith("1000\n00_first_run\n")
    assert not list(course.layer.upper.rglob("solutions"))
