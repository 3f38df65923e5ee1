"""Grading of a class on several machines: Dask's scheduler distributes the jobs to workers, which grade.

Workers need the course installed, in the same version, but no shared files: submissions and recordings are sent as
bytes. Used by `class_run.py` for `--dask`.
"""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Executor

from gz_course.grader.errors import UsageError
from gz_course.grader.printable import shown
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.whole_class.versions import versions

CONNECT = 15.0  # [s] to connect to a scheduler


@contextlib.contextmanager
def dask_executor(
    address: str, check_slots: Callable[[int], None]
) -> Iterator[tuple[Executor, int, Callable[[], bool]]]:
    """Connect to a scheduler (`tcp://host:port`) or start workers here (`local:N`).

    Yields an executor, how many gradings it runs at a time, and a function that returns whether the scheduler is lost.
    `check_slots` gets the largest number of gradings that one machine runs at a time. Raises UsageError if Dask is not
    installed, the scheduler does not answer, or a worker has other versions.
    """
    try:
        import dask
        from distributed import Client, LocalCluster
    except ImportError:
        raise UsageError("--dask needs Dask, which is not installed: pip install 'gz-ros2-course[dask]'") from None
    with contextlib.ExitStack() as stack:
        if address.startswith("local:"):
            count = address.removeprefix("local:")
            if not count.isascii() or not count.isdecimal() or not 1 <= int(count) <= 1000:
                raise UsageError(f"--dask {shown(address)}: expected local:N with the number of workers, as local:2")
            scratch = str(stack.enter_context(TemporaryFolder("course-dask-")))
            stack.enter_context(dask.config.set(temporary_directory=scratch))
            cluster = LocalCluster(
                n_workers=int(count),
                threads_per_worker=1,
                dashboard_address="127.0.0.1:0",
                local_directory=scratch,
                silence_logs="CRITICAL",
            )
            target = stack.enter_context(cluster)
        elif "://" in address:
            target = address
        else:
            raise UsageError(f"--dask {shown(address)}: expected tcp://HOST:PORT of a scheduler, or local:N")
        try:
            client = stack.enter_context(Client(target, timeout=CONNECT, set_as_default=False))
        except (OSError, TimeoutError, ValueError) as error:
            raise UsageError(f"no Dask scheduler answers at {shown(address)}: {shown(str(error))}") from None
        try:
            client.wait_for_workers(1, timeout=CONNECT)
        except (OSError, TimeoutError):
            raise UsageError(
                f"the Dask scheduler at {shown(address)} has no workers; start some with dask worker"
            ) from None
        threads = client.nthreads()
        slots = sum(threads.values())
        machines: Counter[str] = Counter()
        for worker, number in threads.items():
            machines[worker.rpartition(":")[0]] += number
        check_slots(max(machines.values()))
        _check_versions(client.run(_worker_versions, on_error="return"))
        # Not closed by its own context manager, which would wait for gradings that a lost scheduler never reports.
        yield client.get_executor(pure=False, retries=0), slots, lambda: client.status not in ("running", "connecting")


def _worker_versions() -> dict[str, str]:
    return versions()


def _check_versions(of_workers: dict[str, object]) -> None:
    """Raise UsageError if a worker has other versions: equal submissions must get equal scores everywhere."""
    ours = versions()
    for worker, theirs in sorted(of_workers.items()):
        if not isinstance(theirs, dict):
            raise UsageError(f"the Dask worker {worker} cannot grade; is the course installed there? ({theirs})")
        for package, version in ours.items():
            if theirs.get(package) != version:
                raise UsageError(
                    f"the Dask worker {worker} has {package} {theirs.get(package)}, but here it is {version}; "
                    "install the same on both"
                )
