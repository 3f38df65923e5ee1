"""Gradings as children of this process that have done their imports before they begin (`fork_server.py`)."""

from __future__ import annotations

import contextlib
import json
import multiprocessing
import os
import select
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from gz_course.grader.errors import InfrastructureError

SERVER = ("-m", f"{__package__}.fork_server")
ROOM = " " * 200  # in the command line, where a grading shows its folder
DEADLINE = 300.0  # [s] for an answer of the server, also for the first, which comes after its imports
ATTEMPTS = 2  # at a fork; the second with a new server


class ForkedProcess:
    """A child of this process, with the interface of `subprocess.Popen` as far as it is needed."""

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self.returncode: int | None = None
        self._lock = threading.Lock()
        self._handle = os.pidfd_open(pid)

    def poll(self) -> int | None:
        """Return the exit code (negative: a signal's number), None while it runs."""
        with self._lock:
            if self.returncode is None:
                try:
                    pid, status = os.waitpid(self.pid, os.WNOHANG)
                except ChildProcessError:  # somebody else has waited for it
                    pid, status = self.pid, signal.SIGKILL
                if pid:
                    self.returncode = os.waitstatus_to_exitcode(status)
                    os.close(self._handle)
            return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end and return the exit code; raise TimeoutExpired after `timeout` [s]."""
        if (code := self.poll()) is not None:
            return code
        look = select.poll()
        look.register(self._handle, select.POLLIN)
        look.poll(None if timeout is None else timeout * 1000)
        if (code := self.poll()) is None:
            raise subprocess.TimeoutExpired("course", timeout or 0.0)
        return code


class ForkServer:
    """Starts gradings. The server is started with the first one, and again if it was killed.

    `start` and `close` are called by one thread at a time; `stop` may be called meanwhile. The caller is a subreaper.
    """

    def __init__(self, program: Sequence[str] = SERVER) -> None:
        self._program = program
        self._process: subprocess.Popen[bytes] | None = None
        self._channel: Connection | None = None
        self._stopped = False

    @property
    def pid(self) -> int | None:
        """Number of the server, None if there is none."""
        return self._process.pid if self._process is not None else None

    def start(self, folder: Path, arguments: list[str], environment: dict[str, str]) -> ForkedProcess:
        """Run `course` with these arguments in a folder, where its error output goes to the file `stderr`.

        Raises InfrastructureError if it cannot be started, InterruptedError after `stop`.
        """
        order = json.dumps({"folder": str(folder), "arguments": arguments, "environment": environment}).encode()
        for attempt in range(1, ATTEMPTS + 1):
            try:
                if self._channel is None:
                    self._begin()
                assert self._channel is not None
                self._channel.send_bytes(order)
                return ForkedProcess(self._answer(self._channel)["pid"])
            except (EOFError, ConnectionError):  # it was killed
                self.close()
                if self._stopped:
                    raise InterruptedError("no more gradings are started") from None
                if attempt == ATTEMPTS:
                    raise InfrastructureError(
                        "the process that starts gradings ended twice; was memory short?"
                    ) from None
            except BaseException:
                self.close()
                raise
        raise AssertionError

    def _begin(self) -> None:
        ours, theirs = multiprocessing.Pipe()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-P", *self._program, str(os.getpid()), str(theirs.fileno()), ROOM],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        self._channel = ours
        if self._stopped:
            self._process.kill()
        self._answer(ours)  # it has done its imports

    @staticmethod
    def _answer(channel: Connection) -> dict[str, Any]:
        if not channel.poll(DEADLINE):
            raise InfrastructureError(f"the process that starts gradings did not answer within {DEADLINE:g} s")
        answer = json.loads(channel.recv_bytes())
        if "error" in answer:
            raise InfrastructureError(f"no grading can be started: {answer['error']}")
        return answer

    def stop(self) -> None:
        """End the server for good, and a `start` that waits for it; `close` is called nevertheless."""
        self._stopped = True
        if (process := self._process) is not None:
            process.kill()

    def close(self) -> None:
        """End the server; gradings go on."""
        process, self._process = self._process, None
        channel, self._channel = self._channel, None
        if process is not None:
            process.kill()
            process.wait()
        if channel is not None:
            with contextlib.suppress(OSError):
                channel.close()
