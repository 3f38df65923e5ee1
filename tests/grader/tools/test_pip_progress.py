"""What `make` says while pip works: one line that moves, few where lines stay, and pip's own words on an error."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from pathlib import Path

from gz_course.grader.tools import pip_progress

SAID = """Obtaining file:///x
  Installing build dependencies: started
Collecting mujoco==4.0.0 (from -c constraints.txt (line 3))
  Downloading mujoco-4.0.0-cp311.whl (12.5 MB)
Collecting numpy>=1.26
  Using cached numpy.whl (18 MB)
Collecting small
  Downloading small-1.0.whl (500 kB)
Installing collected packages: small, numpy, mujoco
Successfully installed small-1.0
"""


def test_the_line_says_how_far_pip_is() -> None:
    assert list(pip_progress.sentences(SAID.splitlines())) == [
        (True, "pip: package 1, 0 MB loaded; looks at the course"),
        (False, "pip: package 2, 0 MB loaded; looks at mujoco"),
        (False, "pip: package 3, 12 MB loaded; looks at numpy"),
        (False, "pip: package 4, 12 MB loaded; looks at small"),
        (True, "pip: 13 MB loaded; installs 3 packages, which takes a minute"),
    ]


def test_where_lines_stay_there_are_few() -> None:
    stages = [said for stage, said in pip_progress.sentences(f"Collecting a{n}" for n in range(150)) if stage]
    assert len(stages) == 4


def test_an_error_is_that_of_pip(tmp_path: Path) -> None:
    words = ["--no-index", "--find-links", str(tmp_path), "no-such-package-of-the-course"]
    done = subprocess.run(
        [sys.executable, "-I", pip_progress.__file__, *words], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 1 and "no-such-package-of-the-course" in done.stderr


def test_on_a_terminal_the_line_is_written_over(tmp_path: Path) -> None:
    (tmp_path / "pip.py").write_text(f"print({SAID!r})")
    reader, writer = pty.openpty()
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "COLUMNS": "60"}
    done = subprocess.run(
        [sys.executable, pip_progress.__file__, "x"], stdout=writer, env=environment, check=True, timeout=300
    )
    os.close(writer)
    said = os.read(reader, 10_000).decode()
    os.close(reader)
    assert done.returncode == 0 and "\n" not in said and said.endswith("\r\x1b[K")
    assert "looks at mujoco" in said and max(len(each) for each in said.split("\r\x1b[K")) < 60
