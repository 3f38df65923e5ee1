"""A process in its sandbox, used like a `subprocess.Popen`; signals reach it inside its namespaces."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import subprocess
from typing import IO

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run.sandbox.resource_monitor import ResourceMonitor

LONGEST_MESSAGE = 1 << 16  # [bytes]


class SandboxedProcess:
    """A started command. `pid` is the outermost process of the sandbox, which lives as long as any other in it.

    `returncode` is that of the command itself; minus the signal's number if a signal ended it.
    """

    def __init__(
        self, process: subprocess.Popen[bytes], level: str, channel: socket.socket | None, walled: bool
    ) -> None:
        """Take over a process. `channel` leads to `init/main.py`, if any; with `walled` that stays process 1."""
        self._process = process
        self._level = level
        self._channel = channel
        self._walled = walled
        self._told: int | None = None
        self._begun = False  # from then on, what comes through the pipes is the submission's
        self._error = ""
        self._killed = False
        self.monitor: ResourceMonitor | None = None  # set by the caller of `Sandbox.start`
        if channel is not None:
            channel.setblocking(False)

    @property
    def pid(self) -> int:
        """Process id of the outermost process, and id of its process group."""
        return self._process.pid

    @property
    def walled(self) -> bool:
        """Whether all its processes stay below the outermost one."""
        return self._walled

    @property
    def stdout(self) -> IO[bytes]:
        assert self._process.stdout is not None
        return self._process.stdout

    @property
    def stderr(self) -> IO[bytes]:
        assert self._process.stderr is not None
        return self._process.stderr

    @property
    def returncode(self) -> int | None:
        """Exit code of the command, None while it runs."""
        return self.poll()

    @property
    def broken_limit(self) -> str | None:
        """The limit of the whole submission that it broke and was ended for (see `resource_monitor.py`), or None."""
        return self.monitor.broken if self.monitor is not None else None

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    def poll(self) -> int | None:
        """Return the exit code, or None while it runs. Raises InfrastructureError if the sandbox could not be built."""
        code = self._process.poll()
        return None if code is None else self._exit_code(code)

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the end. Raises subprocess.TimeoutExpired, and InfrastructureError as `poll` does."""
        if timeout is not None and self._process.poll() is None:
            self._await_end(timeout)
            timeout = 0
        return self._exit_code(self._process.wait(timeout))

    def _await_end(self, timeout: float) -> None:
        """Wait for the event itself, because `Popen.wait` with a timeout polls and is up to 50 ms late."""
        end = os.pidfd_open(self.pid)
        try:
            watched = select.poll()
            watched.register(end, select.POLLIN)
            watched.poll(timeout * 1000)
        finally:
            os.close(end)

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to every process of the submission that is still in its process group."""
        if self._channel is not None and self._walled:
            with contextlib.suppress(OSError):
                self._channel.send(bytes([number]))
        else:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.pid, number)

    def kill(self) -> None:
        """End everything in the sandbox at once."""
        self._killed = True
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.pid, signal.SIGKILL)

    def close(self) -> None:
        """Close the channel; the process must have been ended before."""
        self._process.wait()
        if self.monitor is not None:
            self.monitor.close()
        if self._channel is not None:
            self._channel.close()

    def _exit_code(self, outermost: int) -> int:
        if self._channel is None:
            return outermost
        self._listen(self._channel)
        if self._error:
            raise InfrastructureError(f"a sandbox of level {self._level} could not be built: {self._error}")
        if self._told is not None:
            return self._told
        if not self._walled:
            return outermost
        if self._killed or self._begun or outermost < 0:
            return -signal.SIGKILL
        raise InfrastructureError(
            f"a sandbox of level {self._level} could not be built: {self._last_words() or f'exit code {outermost}'}"
        )

    def _listen(self, channel: socket.socket) -> None:
        with contextlib.suppress(OSError, ValueError):
            while data := _received(channel):
                what, _, value = data.decode(errors="replace").partition(" ")
                if what == "exit":
                    self._told = int(value)
                elif what == "begun":
                    self._begun = True
                else:
                    self._error = self._error or value

    def _last_words(self) -> str:
        with contextlib.suppress(OSError, ValueError):
            os.set_blocking(self.stderr.fileno(), False)
            return (self.stderr.read() or b"").decode(errors="replace").strip()[:300]
        return ""


def _received(channel: socket.socket) -> bytes:
    """Return the next message.

    If the other end was closed before it had read our last signal, Linux reports a reset once, ahead of the messages.
    """
    with contextlib.suppress(ConnectionResetError):
        return channel.recv(LONGEST_MESSAGE)
    return channel.recv(LONGEST_MESSAGE)
