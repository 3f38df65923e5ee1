"""`make soak`: runs a world for MINUTES of simulated time, then a class of STUDENTS, and prints what has grown.

    python -m gz_course.tests.soak [--minutes 60] [--students 500] [--world sensors.sdf] [--jobs N]

Exit code 1 says that a process has grown by `GROWTH` or more after its warm-up, that descriptors, threads or shared
memory became more, or that something was left in the folder for temporary files.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

from gz_course.tests.soak import class_soak, world_soak
from gz_course.tests.soak.watched import GROWTH, MEGABYTE, Watched


def table_of(title: str, watched: list[Watched]) -> Table:
    """What each process held after its warm-up and in the end."""
    table = Table(title=title, box=None, padding=(0, 2, 0, 0), title_justify="left")
    for heading in (
        "process",
        "samples",
        "RSS [MB]",
        "own memory [MB]",
        "growth [MB]",
        "descriptors",
        "threads",
        "shm",
    ):
        table.add_column(heading, justify="left" if heading == "process" else "right")
    for each in watched:
        first, last = each.early(), each.late()
        table.add_row(
            each.name,
            str(len(each.samples)),
            f"{first.rss / MEGABYTE:.1f} → {last.rss / MEGABYTE:.1f}",
            f"{first.own / MEGABYTE:.1f} → {last.own / MEGABYTE:.1f}",
            f"{(last.own - first.own) / MEGABYTE:+.2f}",
            f"{first.descriptors} → {last.descriptors}",
            f"{first.threads} → {last.threads}",
            f"{first.shared} → {last.shared}",
        )
    return table


def main() -> int:
    parser = argparse.ArgumentParser(prog="soak", description="Look for growth in long runs.")
    parser.add_argument(
        "--minutes", type=float, default=60.0, help="simulated time of the world [min]; 0 leaves it out"
    )
    parser.add_argument("--students", type=int, default=500, help="size of the class; 0 leaves it out")
    parser.add_argument("--world", default="sensors.sdf", help="world that runs")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="gradings at a time")
    chosen = parser.parse_args()
    console = Console(width=140)
    faults: list[str] = []
    with tempfile.TemporaryDirectory(prefix="soak-") as name:
        for title, wanted, run in (
            (
                f"{chosen.minutes:g} min of {chosen.world}",
                chosen.minutes,
                lambda at: world_soak.run(at, chosen.world, chosen.minutes),
            ),
            (
                f"a class of {chosen.students}",
                chosen.students,
                lambda at: class_soak.run(at, chosen.students, chosen.jobs),
            ),
        ):
            if not wanted:
                continue
            folder = Path(name) / title.split()[0].replace("/", "_")
            (folder / "tmp").mkdir(parents=True)
            outcome = run(folder)
            console.print(table_of(title, outcome.watched))
            for line in outcome.told:
                console.print(line, markup=False, highlight=False)
            faults += [f"{title}: {fault}" for fault in outcome.faults()]
    for fault in faults:
        console.print(fault, style="red", markup=False, highlight=False)
    if not faults:
        console.print(f"nothing has grown: less than {GROWTH / MEGABYTE:g} MB in each process", highlight=False)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
