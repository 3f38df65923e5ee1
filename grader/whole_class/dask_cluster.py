"""Grading of a class on several machines: Dask's scheduler distributes the jobs to workers, which grade.

Workers need the course installed, in the same version, but no shared files: submissions and recordings are sent as
bytes. Workers may end and join at any time. One that joins with other versions, or without the sandbox, grades nothing:
it says so instead of grading, and is dismissed. Used by `class_run.py` for `--dask`.
"""

from __future__ import annotations

import contextlib
import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, InvalidStateError
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import CourseError, UsageError
from gz_course.grader.printable import shown
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.run.sandbox import choose
from gz_course.grader.whole_class.versions import versions

if TYPE_CHECKING:
    from distributed import Client

CONNECT = 15.0  # [s] to connect to a scheduler


@dataclass(frozen=True)
class Needs:
    """What a worker must have: equal versions, and a level of the sandbox, as for `choose`."""

    versions: dict[str, str]
    sandbox: str
    demand: str | None


@contextlib.contextmanager
def dask_executor(
    address: str, check_slots: Callable[[int], None], needs: Needs
) -> Iterator[tuple[Executor, Callable[[], int], Callable[[], bool]]]:
    """Connect to a scheduler (`tcp://host:port`) or start workers here (`local:N`).

    Yields an executor and two functions: how many gradings it runs at a time now, and whether the scheduler is lost.
    `check_slots` gets the largest number of gradings that one machine runs at a time. Raises UsageError if Dask is not
    installed, the scheduler does not answer, or a worker does not have what it `needs`.
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
        slots = _Slots(client, check_slots)
        slots()
        _check_workers(client.run(_unfit, needs, on_error="return"))
        # Not closed by its own context manager, which would wait for gradings that a lost scheduler never reports.
        executor = _Checked(client, client.get_executor(pure=False, retries=0), needs)
        yield executor, slots, lambda: client.status not in ("running", "connecting")


@dataclass
class _Slots:
    """How many gradings the workers run at a time. Raises UsageError if a machine has too many for its sandbox."""

    client: Client
    check: Callable[[int], None]
    last: int = 1

    def __call__(self) -> int:
        try:
            threads = self.client.nthreads()
        except Exception:  # the scheduler is lost or starts again; who waits for the gradings will notice
            return self.last
        machines: Counter[str] = Counter()
        for worker, number in threads.items():
            machines[worker.rpartition(":")[0]] += number
        self.check(max(machines.values(), default=1))
        self.last = max(1, sum(threads.values()))
        return self.last


class _UnfitError(Exception):
    """What a worker raises instead of grading: its address, and a sentence that says why it does not fit.

    It is no result, because a worker that holds results cannot be dismissed before another one has taken them.
    """

    @property
    def worker(self) -> str:
        return str(self.args[0])

    @property
    def why(self) -> str:
        return str(self.args[1])


class _Checked(Executor):
    """Dask's executor, but a worker that does not fit is dismissed, and another one does its work."""

    def __init__(self, client: Client, inner: Executor, needs: Needs) -> None:
        self._client, self._inner, self._needs = client, inner, needs
        self._lock = threading.Lock()
        self._dismissed: set[str] = set()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        outer: Future[Any] = Future()
        self._begin(outer, function, arguments)
        return outer

    def _begin(self, outer: Future[Any], function: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        inner = self._inner.submit(_if_fit, self._needs, function, *arguments)
        outer.add_done_callback(lambda done: inner.cancel() if done.cancelled() else None)

        def ended(done: Future[Any]) -> None:
            if outer.cancelled():
                return
            if done.cancelled():
                outer.cancel()
            elif isinstance(error := done.exception(), _UnfitError):
                again = (error, outer, function, arguments)  # in a thread of its own, as Dask calls this in its loop
                threading.Thread(target=self._dismiss, args=again, daemon=True).start()
            elif error is not None:
                _finish(outer, error)
            else:
                _finish(outer, done.result())

        inner.add_done_callback(ended)

    def _dismiss(
        self, unfit: _UnfitError, outer: Future[Any], function: Callable[..., Any], arguments: tuple[Any, ...]
    ) -> None:
        """Say which worker does not fit, end it, and give its work to another one."""
        with self._lock:
            if unfit.worker not in self._dismissed:
                self._dismissed.add(unfit.worker)
                print(f"the Dask worker {unfit.worker} {unfit.why}; it is dismissed", file=sys.stderr, flush=True)
                with contextlib.suppress(Exception):  # it may be gone already
                    self._client.retire_workers([unfit.worker], close_workers=True, remove=True)
        try:
            self._begin(outer, function, arguments)
        except Exception as error:  # the scheduler is lost
            _finish(outer, error)


def _finish(future: Future[Any], result: Any) -> None:
    """Set the result or the exception of a future, unless it was cancelled meanwhile."""
    with contextlib.suppress(InvalidStateError):
        future.set_exception(result) if isinstance(result, BaseException) else future.set_result(result)


def _if_fit(needs: Needs, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call the function on a worker if it fits."""
    if why := _unfit(needs):
        from distributed import get_worker

        raise _UnfitError(get_worker().address, why)
    return function(*arguments)


def _unfit(needs: Needs) -> str:
    """Return why this machine must not grade, as the end of a sentence; empty if it may."""
    here = versions()
    if here != needs.versions:
        package, version = next((each for each in needs.versions.items() if here.get(each[0]) != each[1]), ("more", ""))
        return f"has {package} {here.get(package)}, but here it is {version}; install the same on both"
    try:
        choose(needs.sandbox, needs.demand)
    except CourseError as error:
        return f"has no such sandbox: {shown(str(error))}"
    return ""


def _check_workers(of_workers: dict[str, object]) -> None:
    """Raise UsageError if a worker must not grade: equal submissions must get equal scores everywhere."""
    for worker, why in sorted(of_workers.items()):
        if not isinstance(why, str):
            raise UsageError(f"the Dask worker {worker} cannot grade; is the course installed there? ({why})")
        if why:
            raise UsageError(f"the Dask worker {worker} {why}")
