"""Machines that cannot lock submissions in: which level is left, and that a class is not graded there by accident."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from .conftest import ORDINARY, ROOT

pytestmark = [pytest.mark.proof, pytest.mark.skipif(os.getuid() != 0, reason="only root can become an ordinary user")]
NO_ATTACKS = True
HERE = Path(__file__).parent
PYTHON = [sys.executable, "-I", "-S"]


@pytest.fixture
def run():
    """Run `course` as an ordinary user of a machine that lacks something."""
    with tempfile.TemporaryDirectory(prefix="lesser-") as name:
        home = Path(name)
        home.chmod(0o777)
        (home / "class").mkdir()
        (home / "class/jane.py").write_text("x = (")

        def call(lacks, *arguments):
            become = [*PYTHON, str(HERE / "ordinary_user.py"), str(ORDINARY + 2), str(home)]
            lesser = [*PYTHON, str(HERE / "lesser_machine.py"), lacks]
            course = [sys.executable, "-m", "gz_course.grader.course", *arguments]
            return subprocess.run(
                [*become, *lesser, *course],
                cwd=home,
                env=os.environ | {"COURSE_ROOT": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"},
                capture_output=True,
                text=True,
                check=False,
            )

        yield call


# The rights of root in a container of Docker, by the bits of capabilities(7).
DOCKER = {0, 1, 3, 4, 5, 6, 7, 8, 10, 13, 18, 27, 29, 31}
SYS_ADMIN, NET_ADMIN = 21, 12
AS_IN_DOCKER = """
import ctypes, os, sys
for number in set(range(41)) - set(map(int, sys.argv[1].split(","))):
    ctypes.CDLL(None).prctl(24, number, 0, 0, 0)  # PR_CAPBSET_DROP
os.execv(sys.argv[2], sys.argv[2:])
"""


@pytest.mark.parametrize(
    ("more", "works"),
    [(set(), "C"), ({SYS_ADMIN}, "C"), ({SYS_ADMIN, NET_ADMIN}, "ABC")],
    ids=["as it is", "SYS_ADMIN", "SYS_ADMIN and NET_ADMIN"],
)
def test_what_root_needs_in_a_container_of_docker(more, works):
    kept = ",".join(map(str, DOCKER | more))
    for level in "ABC":
        probe = [sys.executable, "-m", "gz_course.grader.run.sandbox.probe", level, "120"]
        done = subprocess.run([*PYTHON, "-c", AS_IN_DOCKER, kept, *probe], capture_output=True, text=True, check=False)
        assert (done.returncode == 0) is (level in works), (level, done.stdout)


@pytest.mark.parametrize(("lacks", "best"), [("landlock", "A"), ("namespaces", "C"), ("namespaces,landlock", "D")])
def test_a_class_is_graded_at_level_b_or_not_at_all(run, lacks, best):
    done = run(lacks, "grade-all", "03", "class", "--out", "out")
    said = " ".join(done.stderr.split())
    if best == "A":
        assert done.returncode == 0, said
        return
    assert done.returncode == 3, said
    assert f"level B or better is demanded, but the best here is {best}" in said and "A firm sandbox" in said
    done = run(lacks, "grade-all", "03", "class", "--out", "out", "--sandbox", best)
    assert done.returncode == 0, done.stderr
    done = run(lacks, "grade-all", "03", "class", "--out", "again", "--sandbox", best, "--jobs", "2")
    assert done.returncode == 2 and "2 gradings at a time need" in " ".join(done.stderr.split())
