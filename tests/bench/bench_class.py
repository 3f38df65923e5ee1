"""What a class costs: submissions a minute, gradings side by side against one after another, Dask against threads."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from gz_course.tests.bench.row import Row

ROOT = Path(__file__).parents[2]
COURSE = Path(sys.executable).parent / "course"
CLASS = 16  # submissions of the timed runs
RUNS = 2
TOGETHER = 8


def hand_in(folder: Path, count: int) -> Path:
    """A class that hands in the solution and its variants of the teleop exercise in turn."""
    solution = ROOT / "solutions/03_teleop"
    variants = [solution, *sorted(solution.glob("accepted/*")), *sorted(solution.glob("rejected/*"))]
    for number in range(count):
        student = folder / f"student {number:02}"
        student.mkdir(parents=True)
        (student / "teleop_node.py").write_bytes((variants[number % len(variants)] / "teleop_node.py").read_bytes())
    return folder


def grade_all(submissions: Path, out: Path, *options: str) -> float:
    """Grade a class in a process of its own; return its wall time [s]."""
    start = time.monotonic()
    command = [COURSE, "grade-all", "03_teleop", submissions, "--out", out, *options]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    return time.monotonic() - start


def what_differs(one: Path, other: Path) -> list[str]:
    """What of two runs of the same class is not the same: gradebooks, truths, recordings."""
    import rerun_cli

    binary = Path(rerun_cli.__file__).parent / "rerun"
    found = [] if (one / "gradebook.csv").read_bytes() == (other / "gradebook.csv").read_bytes() else ["gradebooks"]
    for report in sorted(one.glob("*/report.json")):
        twin = other / report.parent.name / "report.json"
        hashes = [json.loads(path.read_text())["truth_sha256"] for path in (report, twin)]
        if hashes[0] != hashes[1]:
            found.append(f"truth of {report.parent.name}")
        recordings = [path.parent / "03_teleop.rrd" for path in (report, twin)]
        compared = subprocess.run(
            [binary, "rrd", "compare", "--unordered", *recordings], env=os.environ | {"CI": "1"}, capture_output=True
        )
        if compared.returncode:
            found.append(f"recording of {report.parent.name}")
    return found


def rows() -> Iterator[Row]:
    from distributed import LocalCluster

    with (
        tempfile.TemporaryDirectory(prefix="bench-class-") as name,
        LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            dashboard_address="127.0.0.1:0",
            local_directory=name,
            silence_logs="CRITICAL",
        ) as cluster,
    ):
        folder = Path(name)
        submissions = hand_in(folder / "class", CLASS)
        before = os.times()
        threads = min(grade_all(submissions, folder / f"jobs{run}", "--jobs", "2") for run in range(RUNS))
        spent = (sum(os.times()[2:4]) - sum(before[2:4])) / RUNS
        with ThreadPoolExecutor(2) as both:  # side by side: what else the machine does slows both down alike
            jobs = both.submit(grade_all, submissions, folder / "jobs", "--jobs", "2")
            dask = both.submit(grade_all, submissions, folder / "dask", "--dask", cluster.scheduler_address)
        rate = CLASS / threads * 60
        yield Row("a class, --jobs 2", f"{rate:.0f} submissions/min", "40/min", f"{rate / 40:.2f}x", ">= 1x")
        each = spent / CLASS
        yield Row("processor time of one", f"{each:.2f} s", "2 cores, 40/min: 3 s", f"{each / 3:.2f}x", "< 1x")
        ratio = jobs.result() / dask.result()
        told = f"--jobs 2, side by side: {jobs.result():.1f} s"
        yield Row("Dask, 2 workers", f"{dask.result():.1f} s", told, f"{ratio:.2f}x", ">= 0.9x")
        eight = hand_in(folder / "eight", TOGETHER)
        grade_all(eight, folder / "together", "--jobs", str(TOGETHER))
        grade_all(eight, folder / "alone", "--jobs", "1")
        differ = what_differs(folder / "together", folder / "alone")
        told = ", ".join(differ) or "the same bytes"
        yield Row(f"{TOGETHER} gradings at once", told, "one after another", f"{len(differ)} differ", "0 differ")
