"""A grading in a process of its own, and the watchdog beside it, in the process that waits.

`Supervised` runs jobs one after the other in a child: there the simulator steps its world, and the grader deals with
whatever a submission sends. The parent has no world, no ROS and no threads. It looks every `PERIOD` (`watchdog.py`) at
the processor time of the child and of the box's processes, at memory and at simulated time, none of which depends on
how busy the machine is otherwise; whoever takes too much is ended, and `Broken` says what was too much. An interrupt
ends the child within `GRACE`, wherever it is. Whatever the child leaves (processes, temporary folders) is removed here.
"""

from __future__ import annotations

import contextlib
import ctypes
import mmap
import os
import pickle
import resource
import select
import signal
import struct
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.process.forking import fork
from gz_course.grader.process.interruption import hear_interrupts
from gz_course.grader.process.temporary_folder import abandoned, sweep
from gz_course.grader.run.sandbox.resource_monitor import descendants
from gz_course.grader.run.watchdog import MACHINE, Look

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
PERIOD = 0.2  # [s] between two looks
GRACE = 1.0  # [s] after an interrupt for the child to clean up
MOST_ADDRESSES = 12 << 30  # [bytes] of its address space: one request for more fails at once
LARGEST_FILE = 1 << 30  # [bytes] it may write
WITH_THREADS = {"rerun", "rclpy"}  # modules that start threads and do not survive a fork
_STATE = struct.Struct("qqq")  # job, simulated time [ns], whether a world that was handed in is in use


class Heartbeat:
    """What the child tells about where it is: a few numbers in memory that both sides see."""

    def __init__(self, descriptor: int | None = None) -> None:
        """Share the memory behind a descriptor; without one nobody looks."""
        self.descriptor = descriptor
        self._memory = None if descriptor is None else mmap.mmap(descriptor, _STATE.size)
        self._state = [0, 0, 0]

    def begin(self, job: int) -> None:
        """Say that a job begins."""
        self._write(job, 0, 0)

    def at(self, sim_time_ns: int) -> None:
        """Say how far simulated time has come [ns]."""
        self._write(self._state[0], sim_time_ns, self._state[2])

    def submitted(self) -> None:
        """Say that the simulator begins to build what a submission handed in."""
        self._write(self._state[0], self._state[1], 1)

    def read(self) -> tuple[int, int, int]:
        """Return job, simulated time [ns], and whether anything that was handed in is simulated."""
        assert self._memory is not None
        return _STATE.unpack(self._memory[: _STATE.size])

    def close(self) -> None:
        """Let go of the memory."""
        if self._memory is not None:
            self._memory.close()

    def _write(self, *state: int) -> None:
        self._state = list(state)
        if self._memory is not None:
            self._memory[: _STATE.size] = _STATE.pack(*state)


@dataclass(frozen=True)
class Broken:
    """Why a job was ended before it was done: the outcome of its run, and a sentence."""

    job: int
    outcome: str  # memory | timeout | student_error
    sentence: str


Job = Callable[[Heartbeat], Any]


class Supervised:
    """Runs jobs in a child process. Each is a picklable call with a `Heartbeat`; one simulates `duration` [s]."""

    def __init__(self, jobs: Sequence[Job], duration: float, meanwhile: Callable[[], object] = lambda: None) -> None:
        """Prepare to run jobs; `meanwhile` is called once they have begun, and takes less than a second."""
        self._jobs = list(jobs)
        self._meanwhile = meanwhile
        self._duration = duration
        self._before: set[int] = set()
        self._status: int | None = None  # that of the child, once it was waited for

    def run(self) -> tuple[list[Any], Broken | None]:
        """Return the results of the jobs that came to an end, and what ended the next one, if anything did.

        What a job raises is raised here. Raises InfrastructureError if the child dies for no reason of the jobs.
        """
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # what a killed child leaves comes to us
        self._before = set(descendants(os.getpid()))
        memory = os.memfd_create("heartbeat")
        os.ftruncate(memory, _STATE.size)
        self._heartbeat = Heartbeat(memory)
        reading, writing = os.pipe()
        pid = None
        try:
            pid = _start(self._jobs, memory, writing)
            os.close(writing)
            process = os.pidfd_open(pid)
            try:
                self._meanwhile()
                return self._follow(pid, process, reading)
            finally:
                self._end(pid, process)
                os.close(process)
        finally:
            if pid is None:
                os.close(writing)
            self._heartbeat.close()
            os.close(reading)
            os.close(memory)

    def _follow(self, pid: int, process: int, reading: int) -> tuple[list[Any], Broken | None]:
        poll = select.poll()
        poll.register(reading, select.POLLIN)
        look = Look(pid, self._before, self._duration)
        data = bytearray()
        while True:
            if poll.poll(PERIOD * 1000):
                part = os.read(reading, 1 << 20)
                if not part:
                    break
                data += part
            state = self._heartbeat.read()
            if found := look.at(state[0], state[1], bool(state[2])):
                signal.pidfd_send_signal(process, signal.SIGKILL)
                if found[0] == MACHINE:
                    raise InfrastructureError(found[1])
                return _results(data)[0], Broken(state[0], *found)
        results, last = _results(data)
        if last == "end":
            return results, None
        if last == "memory":
            return results, Broken(len(results), "memory", "Dealing with what was handed in took too much memory.")
        return results, self._why(os.waitstatus_to_exitcode(self._wait(pid)), len(results))

    def _why(self, code: int, job: int) -> Broken:
        """Say why the child died on its own."""
        if not self._heartbeat.read()[2]:
            raise InfrastructureError(f"the process that grades ended with {_how(code)}; grade again")
        if code == -signal.SIGKILL:
            return Broken(job, "memory", "Simulating what was handed in took all the memory there was.")
        return Broken(job, "student_error", f"The simulator crashed ({_how(code)}) with what was handed in.")

    def _end(self, pid: int, process: int) -> None:
        """End the child and all it left; what it cleans up by itself, it may clean up."""
        with contextlib.suppress(ProcessLookupError):
            signal.pidfd_send_signal(process, signal.SIGINT)
            if not _gone(process, GRACE):
                signal.pidfd_send_signal(process, signal.SIGKILL)
        killed = self._wait(pid) != 0
        deadline = time.monotonic() + GRACE
        while (left := set(descendants(os.getpid())) - self._before) and time.monotonic() < deadline:
            for each in left:
                with contextlib.suppress(OSError):
                    os.kill(each, signal.SIGKILL)
            time.sleep(PERIOD / 20)  # until they are gone: they are not ours to wait for
        for each in _zombies(self._before):
            with contextlib.suppress(ChildProcessError):
                os.waitpid(each, os.WNOHANG)
        if killed:
            sweep()
            if abandoned():  # somebody who ended a moment ago had written there meanwhile
                sweep()

    def _wait(self, pid: int) -> int:
        if self._status is None:
            self._status = os.waitpid(pid, 0)[1]
        return self._status


def _start(jobs: list[Job], memory: int, writing: int) -> int:
    """Start a child that does the jobs: a fork of this process, or a new Python where threads forbid that."""
    if _may_fork():
        sys.stdout.flush()
        sys.stderr.flush()
        pid = fork()
        if pid == 0:
            _child(jobs, memory, writing)
        return pid
    command = [
        sys.executable,
        "-P",
        "-c",
        "from gz_course.grader.run.supervision import main; main()",
        str(memory),
        str(writing),
    ]
    started = subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=(memory, writing), process_group=0)
    assert started.stdin is not None
    with contextlib.suppress(BrokenPipeError), started.stdin:
        started.stdin.write(pickle.dumps(jobs))
    started.returncode = 0  # it is waited for by its number
    return started.pid


def _may_fork() -> bool:
    if len(os.listdir("/proc/self/task")) == 1:  # noqa: PTH208
        return True  # a fork itself, which has none of the threads of its modules
    return threading.active_count() == 1 and not WITH_THREADS & sys.modules.keys()


def main() -> None:
    """Do the jobs that come on the standard input; the arguments are two descriptors."""
    memory, writing = map(int, sys.argv[1:])
    _child(pickle.load(sys.stdin.buffer), memory, writing)


def _child(jobs: list[Job], memory: int, writing: int) -> NoReturn:
    code = 1
    try:
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        with contextlib.suppress(OSError):
            os.setpgid(0, 0)  # Ctrl-C is the parent's to hear
        hear_interrupts()
        _limit(resource.RLIMIT_AS, MOST_ADDRESSES)
        _limit(resource.RLIMIT_FSIZE, LARGEST_FILE)
        heartbeat = Heartbeat(memory)
        for number, job in enumerate(jobs):
            heartbeat.begin(number)
            _tell(writing, ("result", job(heartbeat)))
        _tell(writing, ("end", None))
        code = 0
    except MemoryError:
        _tell(writing, ("memory", None))
    except Exception as error:
        error.add_note(traceback.format_exc())
        _tell(writing, ("error", error))
    except BaseException:  # an interrupt: the parent knows
        pass
    finally:
        with contextlib.suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)


def _limit(kind: int, most: int) -> None:
    hard = resource.getrlimit(kind)[1]
    resource.setrlimit(kind, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


def _tell(descriptor: int, what: tuple[str, Any]) -> None:
    try:
        data = pickle.dumps(what)
    except Exception:  # an error that holds what cannot be told
        data = pickle.dumps((what[0], RuntimeError(str(what[1]))))
    view = memoryview(struct.pack("Q", len(data)) + data)
    while view:
        view = view[os.write(descriptor, view) :]


def _results(data: bytearray) -> tuple[list[Any], str]:
    """Return the results told so far and the last word, empty if there was none; raise what a job raised."""
    results: list[Any] = []
    at = 0
    last = ""
    while at + 8 <= len(data):
        size = int.from_bytes(data[at : at + 8], "little")
        if at + 8 + size > len(data):
            break
        kind, value = pickle.loads(data[at + 8 : at + 8 + size])  # from a process of ours
        at, last = at + 8 + size, kind
        if kind == "error":
            raise value
        if kind == "result":
            results.append(value)
    return results, last


def _gone(process: int, patience: float) -> bool:
    poll = select.poll()
    poll.register(process, select.POLLIN)
    return bool(poll.poll(patience * 1000))


def _zombies(apart: set[int]) -> list[int]:
    own = Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    return [int(pid) for pid in own if int(pid) not in apart]


def _how(code: int) -> str:
    if code >= 0:
        return f"exit code {code}"
    with contextlib.suppress(ValueError):
        return signal.Signals(-code).name
    return f"signal {-code}"
