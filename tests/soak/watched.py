"""What processes hold, sampled while they run, and whether it grows after a warm-up.

`own` is the memory that a process does not share with files: its part of anonymous and of shared memory. The part of
mapped files depends on which other processes of the machine map them, so it is no sign of growth.

Source: proc_pid_smaps(5), "smaps_rollup": Pss_Anon and Pss_Shmem.
"""

import contextlib
import os
import statistics
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import psutil

MEGABYTE = 1 << 20
GROWTH = 5 * MEGABYTE  # of a process after its warm-up, at which it fails
MORE = 2  # descriptors, threads or entries of shared memory: at most this many more in the end
WARM_UP, WINDOW = 0.25, 0.2  # parts of the samples: left out at the start; averaged after that, and at the end
PERIOD = 1.0  # [s] between two samples
FEWEST = 10  # samples, so that a process is judged
SHARED = "/dev/shm/"
OF_THE_MACHINE = "/dev/shm/lttng-ust-wait-"  # made once and kept by the tracing library of ROS


@dataclass(frozen=True)
class Sample:
    """Memory in bytes, and numbers of what is open."""

    rss: float
    own: float
    descriptors: int
    threads: int
    shared: int


@dataclass
class Watched:
    """A process with a name, and its samples."""

    name: str
    pid: int
    samples: list[Sample] = field(default_factory=list)
    segments: set[str] = field(default_factory=set)

    def sample(self) -> bool:
        """Take a sample; return False if the process has ended."""
        place = Path(f"/proc/{self.pid}")
        try:
            sizes = {}
            for line in (place / "smaps_rollup").read_text().splitlines()[1:]:
                name, _, size = line.partition(":")
                sizes[name] = int(size.split()[0]) << 10
            held = [str(each.readlink()) for each in (place / "fd").iterdir()]
            mapped = {line.split(None, 5)[5] for line in (place / "maps").read_text().splitlines() if SHARED in line}
            threads = len(list((place / "task").iterdir()))
        except (OSError, IndexError):
            return False
        shared = {name for name in {*held, *mapped} if name.startswith(SHARED) and not name.startswith(OF_THE_MACHINE)}
        self.segments |= {name for name in shared if not name.endswith("(deleted)")}
        own = sizes.get("Pss_Anon", 0) + sizes.get("Pss_Shmem", 0)
        self.samples.append(Sample(sizes["Rss"], own, len(held), threads, len(shared)))
        return True

    def _middle(self, samples: list[Sample]) -> Sample:
        def of(name: str) -> float:
            return statistics.median([getattr(each, name) for each in samples])

        return Sample(of("rss"), of("own"), int(of("descriptors")), int(of("threads")), int(of("shared")))

    def early(self) -> Sample:
        """What it held right after the warm-up."""
        start = int(len(self.samples) * WARM_UP)
        return self._middle(self.samples[start : start + max(1, int(len(self.samples) * WINDOW))])

    def late(self) -> Sample:
        """What it held in the end."""
        return self._middle(self.samples[-max(1, int(len(self.samples) * WINDOW)) :])

    def faults(self) -> list[str]:
        if len(self.samples) < FEWEST:
            return [f"{self.name} was seen {len(self.samples)} times only; run longer"]
        first, last = self.early(), self.late()
        found = []
        if last.own - first.own >= GROWTH:
            found.append(f"{self.name} has grown by {(last.own - first.own) / MEGABYTE:.1f} MB")
        for name in ("descriptors", "threads", "shared"):
            before, after = getattr(first, name), getattr(last, name)
            if after > before + MORE:
                found.append(f"{self.name} has {after} {name} instead of {before}")
        return found


@dataclass
class Outcome:
    """What one long run came to: processes, lines for the reader, and faults besides growth."""

    watched: list[Watched]
    told: list[str]
    wrong: list[str]

    def faults(self) -> list[str]:
        return [fault for each in self.watched for fault in each.faults()] + self.wrong


def watch(
    found: Callable[[], list[Watched]], finished: Callable[[], bool], wake: threading.Event | None = None
) -> list[Watched]:
    """Sample the processes that `found` returns, until `finished`; return all of them that lived long enough."""
    wake = wake or threading.Event()
    known: dict[int, Watched] = {}
    while not finished():
        for each in found():
            known.setdefault(each.pid, each)
        for each in known.values():
            each.sample()
        wake.wait(PERIOD)
    return list(known.values())


def shared_names() -> set[str]:
    """Return the paths of all shared memory of this machine."""
    return {str(path) for path in Path(SHARED).glob("*")}


def left_behind(watched: list[Watched], folder: Path, before: set[str]) -> list[str]:
    """Faults after the end of all processes: files for a moment that stayed, and shared memory that is new.

    Ports of Fast DDS may be from `before`, or be used by other programs of this machine.
    """
    names = {name for each in watched for name in each.segments} & shared_names() - before
    used = _mapped_by_somebody() if names else ""
    wrong = [f"left in shared memory: {name}" for name in sorted(names) if f"{name}\n" not in used]
    return wrong + [f"left in the folder for temporary files: {path.name}" for path in sorted(folder.iterdir())]


def _mapped_by_somebody() -> str:
    found = []
    for place in Path("/proc").glob("[0-9]*/maps"):
        with contextlib.suppress(OSError):
            found.append(place.read_text())
    return "".join(found)


def entries(folder: Path) -> int:
    """How many files and folders a folder holds, however deep."""
    with contextlib.suppress(OSError):
        return sum(len(folders) + len(files) for _, folders, files in os.walk(folder))
    return 0


def end(processes: list[psutil.Popen]) -> list[str]:
    """End processes in this order: SIGINT, then SIGKILL; return the names of those that needed the latter."""
    stubborn = []
    for process in processes:
        if process.poll() is None:
            with contextlib.suppress(psutil.Error, OSError):
                process.send_signal(2)
        try:
            process.wait(60)
        except psutil.TimeoutExpired:
            stubborn.append(" ".join(process.cmdline()[:4]))
            process.kill()
            process.wait(60)
    return stubborn
