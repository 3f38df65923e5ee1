"""Can a recording be written and read back unchanged?"""

from __future__ import annotations

from gz_course.grader.tools.doctor.probe import ProbeError, Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine

TITLE = "recordings"
_CODE = """
import sys
from pathlib import Path
import rerun
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
path = Path(sys.argv[1])
values = [0.25, 0.5, 0.75]
with Recorder(path, "robot") as recorder:
    for number, value in enumerate(values):
        recorder.set_time(number * 10_000_000)
        recorder.scalar("truth/robot/x", value)
read = Recording(path).signal("truth/robot/x").values.tolist()
if read != values:
    sys.exit(f"wrote {values}, read {read}")
print(f"Rerun {rerun.__version__} wrote {path.stat().st_size} bytes and read them back")
"""


def examine(probes: Probes) -> Verdict:
    """Write and read a small one with the grader's own recorder and reader."""
    try:
        seen = probes.run(_CODE, str(probes.folder / "doctor.rrd")).splitlines()[-1]
    except ProbeError as error:
        return failed(
            f"a recording cannot be written and read: {error}",
            "install the tested version again: `pip install -c constraints.txt --force-reinstall rerun-sdk`",
        )
    kept = "`course show` keeps the viewer from sending usage data, its page in a browser from asking another machine"
    return fine(f"{seen}; {kept}")
