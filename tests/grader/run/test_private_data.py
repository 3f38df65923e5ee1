"""Private data of a trial reach the checks and the recording, and nothing of a submission; a trial changes a check."""

import shutil

from gz_course.grader.record.reading import Recording

NAME = "00_first_run"
SECRET = "zebra-4711"
TRIALS = f"""
[[trial]]
name = "secret"
private = {{ word = "{SECRET}" }}

[trial.check.arrives]
gate = {{ signal = "truth/robot/x", reaches = 99, otherwise = "changed by the trial" }}
"""
# Looks at all that a process can read of itself and its parents, and at the files it was given.
SPY = """
import os
from pathlib import Path

found = 0
for folder in ("/proc/self", f"/proc/{os.getppid()}"):
    for name in ("environ", "cmdline"):
        try:
            found += b"WORD" in Path(folder, name).read_bytes()
        except OSError:
            pass
for folder in {str(Path(__file__).parent), os.getcwd(), os.environ.get("HOME", "."), os.environ.get("TMPDIR", ".")}:
    for path in Path(folder).rglob("*"):
        try:
            found += path.is_file() and path.name != Path(__file__).name and b"WORD" in path.read_bytes()
        except OSError:
            pass
print("the spy found", found, flush=True)
""".replace("WORD", "zebra-" + "4711")


def test_what_is_private_stays_with_the_checks(grade, root, tmp_path):
    spying = tmp_path / "hello_node.py"
    shutil.copy(root / "solutions" / NAME / "hello_node.py", spying)
    spying.write_text(f"{SPY}\n{spying.read_text()}")
    (tmp_path / "trials.toml").write_text(TRIALS)
    outcome = grade(NAME, spying, "--trials", tmp_path / "trials.toml")
    assert "arrives" in outcome.failed(), outcome.output
    assert "changed by the trial" in outcome.output
    recording = Recording(outcome.recording)
    assert recording.private == {"word": SECRET}
    said = [line.text for line in recording.lines("log/student")]
    assert "the spy found 0" in said, said
    assert SECRET not in outcome.output
