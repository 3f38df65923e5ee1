"""Has an earlier run left something behind: shared memory of DDS, processes, temporary folders?

Only what belongs to this user and is no longer in use is reported.
"""

from __future__ import annotations

import os
import re
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

import psutil

from gz_course.grader.process.temporary_folder import OWNER, abandoned
from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, fine, warning

TITLE = "leftovers of earlier runs"
SHARED_MEMORY = Path("/dev/shm")
OF_DDS = ("fastrtps_", "fastdds_", "sem.fastrtps_", "sem.fastdds_")
OF_THE_COURSE = re.compile(
    r"(course(-(class|dask|doctor|given|verify|workers))?|playground)-\w{8}"
)  # of temporary folders
PARTITIONS = ("student-", "grader-", "playground-")  # names of Gazebo partitions that only the course uses
OLD = 3600.0  # [s]; a younger folder may be that of a run that is starting
SHOWN = 3


def examine(probes: Probes) -> Verdict:
    """Look for all three."""
    processes = [process for process in psutil.process_iter() if process.pid != os.getpid()]
    if orphans := [process for process in processes if orphaned(process)]:
        numbers = " ".join(str(process.pid) for process in orphans)
        return warning(f"{_count(orphans, 'process')} of an earlier run: {numbers}", f"end them: `kill {numbers}`")
    if segments := unused_segments(SHARED_MEMORY, in_use(processes, SHARED_MEMORY)):
        return warning(
            f"{_count(segments, 'file')} of DDS in {SHARED_MEMORY} that no process uses: {_few(segments)}",
            "remove them: `fastdds shm clean`; they come from nodes that were killed",
        )
    folder = Path(tempfile.gettempdir())
    if dead := abandoned():
        return warning(
            f"{_count([path.name for path in dead], 'folder')} in {folder} of runs that were killed",
            "nothing: the next `course grade` removes them",
        )
    if folders := old_folders(folder, time.time()):
        names = " ".join(str(folder / name) for name in folders[:SHOWN])
        return warning(
            f"{_count(folders, 'folder')} of earlier runs in {folder}", f"remove them, such as `rm -r {names}`"
        )
    return fine("nothing is left of earlier runs")


def orphaned(process: psutil.Process) -> bool:
    """Return whether a process belongs to a run of the course whose grader or notebook has ended."""
    try:
        if process.uids().real != os.getuid() or process.ppid() != 1:
            return False
        return process.environ().get("GZ_PARTITION", "").startswith(PARTITIONS)
    except (psutil.Error, OSError):
        return False


def in_use(processes: Iterable[psutil.Process], folder: Path) -> set[str]:
    """Return the names of the files in a folder that a process has mapped or opened."""
    found: set[str] = set()
    for process in processes:
        here = Path("/proc") / str(process.pid)
        try:
            maps = (here / "maps").read_text(errors="replace")
            found.update(Path(line.rpartition(" ")[2]).name for line in maps.splitlines() if f"{folder}/" in line)
            found.update(Path(os.readlink(link)).name for link in (here / "fd").iterdir())  # noqa: PTH115
        except OSError:  # it has ended meanwhile, or belongs to another user
            continue
    return found


def unused_segments(folder: Path, used: set[str]) -> list[str]:
    """Return the names of this user's files of DDS that no process uses."""
    return sorted(path.name for path in _mine(folder) if path.name.startswith(OF_DDS) and not _belongs(path.name, used))


def _belongs(name: str, used: set[str]) -> bool:
    """Return whether a file belongs to a segment in use, as a lock (`..._el`) and a semaphore (`sem...._mutex`) do."""
    plain = name.removeprefix("sem.").removesuffix("_mutex").removesuffix("_el")
    return any(plain == other.removeprefix("sem.").removesuffix("_mutex").removesuffix("_el") for other in used)


def old_folders(folder: Path, now: float) -> list[str]:
    """Return the names of this user's old temporary folders without an owner; `now` [s] since the epoch."""
    return sorted(
        path.name
        for path in _mine(folder)
        if OF_THE_COURSE.fullmatch(path.name)
        and path.is_dir()
        and now - path.lstat().st_mtime > OLD
        and not (path / OWNER).exists()
    )


def _mine(folder: Path) -> list[Path]:
    found = []
    try:
        for path in folder.iterdir():
            if path.lstat().st_uid == os.getuid():
                found.append(path)
    except OSError:
        pass
    return found


def _count(things: list[str] | list[psutil.Process], noun: str) -> str:
    plural = noun + ("es" if noun.endswith("s") else "s")
    return f"1 {noun}" if len(things) == 1 else f"{len(things)} {plural}"


def _few(names: list[str]) -> str:
    return ", ".join(names[:SHOWN]) + (", ..." if len(names) > SHOWN else "")
