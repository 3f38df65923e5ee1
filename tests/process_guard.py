"""A process that waits for the end of a test process and then kills what that one has left running.

Every process a test starts inherits a mark in its environment. A graded submission has an environment of its own, but
its folders lie in the folder of the tests. The guard is no child of the test process: it outlives it, whatever signal
ends it, and no test finds it among its own children.
"""

import contextlib
import os
import select
import signal
import subprocess
import sys
import time
import uuid

import psutil

MARK = "TEST_PROCESS_MARK"
LONGEST_CLEANING_S = 120


def marked(mark, folder=None):
    """Return the living processes that carry a mark, or one below it, and all their descendants.

    So do processes with a variable that names a file in a folder.
    """
    found = set()
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, OSError):  # gone meanwhile, or a zombie, or somebody else's
            variables = process.environ()
            carried = variables.get(MARK, "")
            inside = folder is not None and any(value.startswith(f"{folder}/") for value in variables.values())
            if carried == mark or carried.startswith(f"{mark}/") or inside:
                found |= {process, *process.children(recursive=True)}
    return [each for each in found if each.is_running() and not is_zombie(each)]


def is_zombie(process):
    try:
        return process.status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


def watch_over_this_process(folder):
    """Mark whatever this process starts from now on, and start its guard. `folder` is for the files of its tests."""
    outer = os.environ.get(MARK)
    mark = "/".join([*([outer] if outer else []), uuid.uuid4().hex])
    unmarked = {name: value for name, value in os.environ.items() if name != MARK}
    subprocess.run(
        [sys.executable, "-I", __file__, mark, str(os.getpid()), str(folder)],
        env=unmarked,
        cwd="/",
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    os.environ[MARK] = mark


def main():
    mark, watched, folder = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    with contextlib.suppress(ProcessLookupError):
        descriptor = os.pidfd_open(watched)
        if os.fork():
            return
        os.setsid()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)
        select.select([descriptor], [], [])
    end = time.monotonic() + LONGEST_CLEANING_S
    while (
        left := marked(mark, folder)
    ) and time.monotonic() < end:  # again: one of them may have started another meanwhile
        for process in left:
            with contextlib.suppress(psutil.Error):
                process.kill()
        psutil.wait_procs(left, 5)


if __name__ == "__main__":
    main()
