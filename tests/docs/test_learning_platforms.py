"""The page on learning platforms: its limits are those of the grader, and its workflow says what Classroom reads."""

import base64
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from gz_course.grader.submission import archive, intake

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "learning_platforms.md").read_text()


def test_limits_are_those_of_the_grader():
    assert f"over {intake.LARGEST >> 20} MiB, over {intake.LARGEST_FOLDER >> 20} MiB" in PAGE
    assert f"{intake.MOST_FILES} files in all, an archive over {archive.LARGEST_ARCHIVE >> 20} MiB" in PAGE
    for name in intake.STAND_INS:
        assert f"`{name}.py`" in PAGE


@pytest.fixture
def workflow():
    return yaml.safe_load(re.search(r"```yaml\n(.*?)^```$", PAGE, re.M | re.S)[1])


@pytest.mark.parametrize("points", [20, 0])
def test_the_workflow_of_github_classroom_reports_the_points_of_each_check(workflow, tmp_path, points):
    (step,) = [step for step in workflow["jobs"]["grade"]["steps"] if step.get("id") == "teleop"]
    checks = [
        {"title": "Stops", "status": "passed" if points else "failed", "points": points, "hint": None},
        {"title": 'Turns "left"', "status": "passed", "points": 80, "hint": None},
    ]
    (tmp_path / "report.json").write_text(json.dumps({"score": 80 + points, "max_score": 100, "checks": checks}))
    script = re.sub(r"^course grade .*? \|\|", "(exit 1) ||", step["run"], flags=re.M)
    done = subprocess.run(
        ["bash", "-eo", "pipefail", "-c", script],
        cwd=tmp_path,
        env={"GITHUB_OUTPUT": str(tmp_path / "output"), "PATH": f"{Path(sys.executable).parent}:/usr/bin:/bin"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    name, _, value = (tmp_path / "output").read_text().strip().partition("=")
    told = json.loads(base64.b64decode(value))
    assert (name, told["status"], told["max_score"]) == ("result", "pass" if points else "fail", 100)
    assert [test["score"] for test in told["tests"]] == [points, 80]
    reporter = workflow["jobs"]["grade"]["steps"][-2]
    assert f"{reporter['with']['runners'].upper()}_RESULTS" in reporter["env"]
