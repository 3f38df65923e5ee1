"""What a class costs: submissions a minute, gradings side by side against one after another, Dask against threads."""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import psutil

from gz_course.tests.bench.row import Row

ROOT = Path(__file__).parents[2]
COURSE = Path(sys.executable).parent / "course"
CLASS = 16  # submissions of the timed runs
RUNS = 2
TOGETHER = 8
MOST = 1200 << 20  # [bytes] of memory that so many gradings at a time may take
LOOK = 0.2  # [s] between two looks at it


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


def processor_time(command: list[str | Path], out: Path) -> float:
    """Return the processor time [s] of a command and of all it starts."""
    before = os.times()
    subprocess.run([*command, "--out", out], cwd=ROOT, check=True, capture_output=True)
    return sum(os.times()[2:4]) - sum(before[2:4])


def memory(arguments: list[str | Path]) -> int:
    """Run a `course` command; return the most memory of its processes [bytes], what they share counted once."""
    process = subprocess.Popen([COURSE, *arguments], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    most = 0
    while process.poll() is None:
        total = 0
        for each in [psutil.Process(process.pid), *psutil.Process(process.pid).children(recursive=True)]:
            with contextlib.suppress(psutil.Error, OSError):
                total += each.memory_full_info().pss
        most = max(most, total)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(LOOK)
    return most


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
        yield Row("a class, --jobs 2", f"{rate:.0f} submissions/min", "60/min", f"{rate / 60:.2f}x", ">= 1x")
        each = spent / CLASS
        yield Row("processor time of one", f"{each:.2f} s", "2 cores, 60/min: 2 s", f"{each / 2:.2f}x", "< 1x")
        cold = processor_time(
            [COURSE, "grade", "03_teleop", "--submission", ROOT / "solutions/03_teleop"], folder / "one"
        )
        yield Row("the same", f"{each:.2f} s", f"course grade alone: {cold:.2f} s", f"{each / cold:.2f}x", "< 0.7x")
        eight = hand_in(folder / "eight", TOGETHER)
        used = memory(["grade-all", "03_teleop", eight, "--out", folder / "memory", "--jobs", str(TOGETHER)])
        yield Row(f"memory of --jobs {TOGETHER}", f"{used >> 20} MiB", "1200 MiB", f"{used / MOST:.2f}x", "< 1x")
        ratio = jobs.result() / dask.result()
        told = f"--jobs 2, side by side: {jobs.result():.1f} s"
        yield Row("Dask, 2 workers", f"{dask.result():.1f} s", told, f"{ratio:.2f}x", ">= 0.9x")
        grade_all(eight, folder / "together", "--jobs", str(TOGETHER))
        grade_all(eight, folder / "alone", "--jobs", "1")
        differ = what_differs(folder / "together", folder / "alone")
        told = ", ".join(differ) or "the same bytes"
        yield Row(f"{TOGETHER} gradings at once", told, "one after another", f"{len(differ)} differ", "0 differ")
