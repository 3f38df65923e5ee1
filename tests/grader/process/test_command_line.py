"""What others see of a command line: neither seed nor trials."""

import subprocess
import sys

CODE = """
from pathlib import Path
from gz_course.grader.process.command_line import blot_out
blot_out()
print(Path("/proc/self/cmdline").read_text().split("\\0")[3:])
"""


def test_seed_and_trials_do_not_stand_there():
    words = ["grade", "03", "--seed", "4711", "--out", "runs", "--trials=/secret/trials.toml"]
    done = subprocess.run([sys.executable, "-c", CODE, *words], capture_output=True, text=True, check=True)
    shown = ["grade", "03", "--seed", "....", "--out", "runs", "--trials=" + "." * len("/secret/trials.toml"), ""]
    assert done.stdout == f"{shown}\n"
