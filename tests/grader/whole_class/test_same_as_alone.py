"""What a class gets is what each submission gets alone: `course grade-all` against `course grade`, one by one."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.proof, pytest.mark.timeout(2400)]

FILE = "teleop_node.py"
COURSE = [sys.executable, "-c", "from gz_course.grader.course import main; main()"]
HOST = ("run_wall_seconds", "wall_seconds", "real_time_factor", "submission")  # what differs from run to run
FAULTY = {
    "dies": b"import os\nos.abort()\n",
    "no Python": b"x = (",
    "leaves traces": b"import os, sys\nos.environ['ROS_DOMAIN_ID'] = '5'\nopen('left', 'w').write('me')\nsys.exit(4)\n",
}


def what_counts(path):
    """A report without the facts of host and place, as bytes."""
    report = json.loads(path.read_text())
    for place in (report, *report["trials"]):
        place["recording"] = Path(place["recording"]).name
    return json.dumps({key: value for key, value in report.items() if key not in HOST}, indent=2).encode()


def test_reports_are_those_of_each_graded_alone(root, tmp_path, course_environment):
    solution = root / "solutions/03_teleop"
    variants = {path.parent.name: path.read_bytes() for path in sorted(solution.rglob(FILE))} | FAULTY
    assert len(variants) >= 12
    for name, data in variants.items():
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / FILE).write_bytes(data)

    def course(*arguments):
        done = subprocess.run(
            [*COURSE, *map(str, arguments)],
            cwd=tmp_path,
            env=course_environment(tmp_path),
            capture_output=True,
            text=True,
        )
        assert done.returncode in (0, 1), done.stderr

    course("grade-all", "03", tmp_path / "class", "--out", tmp_path / "out", "--jobs", "2")
    different = []
    for name in variants:
        alone = tmp_path / "alone" / name
        course(
            *("grade", "03", "--submission", tmp_path / "class" / name, "--no-page"),
            *("--out", alone, "--json", alone / "report.json"),
        )
        if what_counts(alone / "report.json") != what_counts(tmp_path / "out" / name / "report.json"):
            different.append(name)
    assert different == []
    assert list((tmp_path / "tmp").iterdir()) == []
