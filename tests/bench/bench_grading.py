"""What a grading costs, and that it never depends on what else the machine does."""

import json
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import psutil

from gz_course.tests.bench.row import Row

ROOT = Path(__file__).parents[2]
COURSE = Path(sys.executable).parent / "course"
COLD_RUNS = 5
PROOF_RUNS = 30
BUSY = 4


def grade(out: Path, *options: str | Path) -> tuple[float, dict]:
    """Grade the teleop solution in a process of its own; return its wall time [s] and its report."""
    report = out / "report.json"
    start = time.monotonic()
    command = [COURSE, "grade", "03_teleop", "--submission", ROOT / "solutions/03_teleop", "--out", out]
    subprocess.run([*command, "--json", report, *options], cwd=ROOT, check=True, capture_output=True)
    return time.monotonic() - start, json.loads(report.read_text())


def peak_memory(command: list) -> int:
    """Run a command; return the largest sum of resident memory over its process tree [bytes]."""
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL)
    tree, peak, done = psutil.Process(process.pid), 0, threading.Event()
    threading.Thread(target=lambda: (process.wait(), done.set()), daemon=True).start()
    while not done.wait(0.01):
        total = 0
        for part in [tree, *_children(tree)]:
            try:
                total += part.memory_info().rss
            except psutil.NoSuchProcess:
                continue
        peak = max(peak, total)
    return peak


def _children(tree: psutil.Process) -> list[psutil.Process]:
    try:
        return tree.children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def rows() -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        imports = [sys.executable, "-c", "import rclpy, mujoco, rerun, typer"]
        reference = statistics.median(_seconds(imports) for _ in range(COLD_RUNS))
        runs = [grade(out) for _ in range(COLD_RUNS)]
        cold = statistics.median(wall for wall, _ in runs)
        yield Row(
            "course grade 03_teleop, start to report",
            f"{cold:.2f} s",
            f"importing its libraries: {reference:.2f} s",
            f"{cold / reference:.1f}",
            "at most 1.5 s",
        )
        files = ["--html", out / "report.html", "--gradescope", out / "results.json", "--junit", out / "junit.xml"]
        every = statistics.median(grade(out, *files)[0] for _ in range(COLD_RUNS))
        yield Row(
            "the same with HTML, Gradescope and JUnit reports",
            f"{every:.2f} s",
            f"without: {cold:.2f} s",
            f"{every / cold:.2f}",
            "at most 3 s",
        )
        stepped = statistics.median(report["run_wall_seconds"] for _, report in runs)
        paced = grade(out, "--pace", "realtime")[1]["run_wall_seconds"]
        yield Row(
            "running part in lock-step",
            f"{stepped:.2f} s",
            f"--pace realtime: {paced:.2f} s",
            f"{paced / stepped:.1f} x faster",
            "at least 8 x",
        )
        command = [COURSE, "grade", "03_teleop", "--submission", ROOT / "solutions/03_teleop", "--out", out]
        peak, alone = peak_memory(command), peak_memory(imports)
        yield Row(
            "peak resident memory of the process tree",
            f"{peak / 1e6:.0f} MB",
            f"importing its libraries: {alone / 1e6:.0f} MB",
            f"{peak / alone:.1f}",
            "at most 500 MB",
        )
        yield _proof(out)


def _seconds(command: list) -> float:
    start = time.monotonic()
    subprocess.run(command, check=True)
    return time.monotonic() - start


def _proof(out: Path) -> Row:
    reports = [grade(out)[1] for _ in range(PROOF_RUNS // 2)]
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(BUSY)]
    try:
        reports += [grade(out)[1] for _ in range(PROOF_RUNS - len(reports))]
    finally:
        for process in busy:
            process.kill()
            process.wait()
    scores = {report["score"] for report in reports}
    hashes = {report["truth_sha256"] for report in reports}
    idle, loaded = (
        statistics.median(r["run_wall_seconds"] for r in part)
        for part in (reports[: PROOF_RUNS // 2], reports[PROOF_RUNS // 2 :])
    )
    return Row(
        f"{PROOF_RUNS} gradings, half of them beside {BUSY} busy processes",
        f"{len(scores)} score, {len(hashes)} truth hash",
        f"running part {idle:.2f} s idle, {loaded:.2f} s loaded",
        f"{loaded / idle:.1f} x slower",
        "1 score, 1 hash",
    )
