"""Which program a process of the submission has started."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.grader.run.agent.course_agent.python_3 import _program

STARTS = 100  # of which many are looked at before exec() has set the command line


@pytest.mark.parametrize(("options", "heard_of"), [(["-I", "-S"], False), (["-u"], True)])
def test_a_python_that_ignores_its_environment_is_not_waited_for(options, heard_of):
    names = set()
    for _ in range(STARTS):
        with subprocess.Popen([sys.executable, *options, "-c", "input()"], stdin=subprocess.PIPE) as process:
            names.add(_program(process.pid))
            process.kill()
    assert names == {Path(os.path.realpath(sys.executable)).name if heard_of else ""}


def test_a_process_that_has_ended_runs_nothing():
    with subprocess.Popen(["true"]) as process:
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        assert _program(process.pid) == ""
