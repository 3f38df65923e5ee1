"""A child process in its own process group, with its output and its end.

The event loop watches file descriptors for the output and for the end of the process (a pidfd). The output of a child
is always read before its end is reported.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import pty
import signal
import subprocess
import threading
from collections.abc import Callable, Mapping, Sequence

from gz_course.sim.child_end import await_end
from gz_course.sim.orphan_watch import unwatch, watch

_CHUNK = 65536
_LARGEST_PIPE = 1 << 20
# Children inherit ignored and blocked signals of the parent, so these are reset.
_DEFAULT_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGCHLD)


class ChildProcess:
    """A running `command`, started by the constructor. Raises OSError if that fails.

    `on_output(stream, data)` is called with data from `stdout` and `stderr`. With `emulate_tty` both are terminals for
    the child.
    """

    def __init__(
        self,
        command: Sequence[str] | str,
        *,
        shell: bool,
        cwd: str | None,
        env: Mapping[str, str] | None,
        emulate_tty: bool,
        on_output: Callable[[str, bytes], None],
    ) -> None:
        self._loop = asyncio.get_running_loop()
        self._on_output = on_output
        self._readers: dict[int, str] = {}
        self._unsent = bytearray()
        self._reaped = False
        out, err = (pty.openpty() if emulate_tty else os.pipe() for _ in range(2))
        stdin_read, self._stdin = os.pipe()
        try:
            self._process = subprocess.Popen(
                command,
                shell=shell,
                cwd=cwd,
                env=env,
                stdin=stdin_read,
                stdout=out[1],
                stderr=err[1],
                process_group=0,
                preexec_fn=_set_default_signals if _signals_are_tampered() else None,
            )
        except BaseException:
            for descriptor in (*out, *err, self._stdin):
                os.close(descriptor)
            self._stdin = -1
            raise
        finally:
            os.close(stdin_read)
        watch(self.pid)
        os.close(out[1])
        os.close(err[1])
        os.set_blocking(self._stdin, False)
        for stream, descriptor in (("stdout", out[0]), ("stderr", err[0])):
            os.set_blocking(descriptor, False)
            self._readers[descriptor] = stream
            self._loop.add_reader(descriptor, self._read, descriptor)

    @property
    def pid(self) -> int:
        """Return the id of the process, which is also that of its group."""
        return self._process.pid

    async def wait(self) -> int:
        """Return the exit code, or -n for signal n, after the process has ended and its output was read."""
        await _end_of(self.pid)
        for descriptor in list(self._readers):
            self._read(descriptor, at_most=_LARGEST_PIPE)
        code = self._process.wait()
        self._reaped = True
        return code

    def has_background_processes(self) -> bool:
        """Return whether processes of its group are still running after its end."""
        try:
            os.killpg(self.pid, 0)
        except ProcessLookupError:
            return False
        except PermissionError:
            pass
        return True

    async def wait_for_group(self) -> None:
        """Wait until the last process of its group has ended."""
        while self.has_background_processes():
            member = _member_of_group(self.pid)
            if member is None:
                return
            await _end_of(member)

    def send_signal(self, number: int) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if not self._reaped or self.has_background_processes():
                os.killpg(self.pid, number)

    def kill(self) -> None:
        """Kill the whole group and reap the child; for use without an event loop."""
        self.send_signal(signal.SIGKILL)
        self._reaped = await_end(self._process, 1.0) is not None

    def write(self, data: bytes) -> None:
        """Write to its stdin, without blocking."""
        self._unsent += data
        if self._stdin >= 0:
            self._send()

    def close(self) -> None:
        """Close its input and output after the end of its group."""
        unwatch(self.pid)
        for descriptor in list(self._readers):
            self._close_reader(descriptor)
        if self._stdin >= 0:
            self._loop.remove_writer(self._stdin)
            os.close(self._stdin)
            self._stdin = -1

    def _send(self) -> None:
        try:
            del self._unsent[: os.write(self._stdin, self._unsent)]
        except BlockingIOError:
            pass
        except OSError:
            self._unsent.clear()
        if self._unsent:
            self._loop.add_writer(self._stdin, self._send)
        else:
            self._loop.remove_writer(self._stdin)

    def _read(self, descriptor: int, at_most: int = _CHUNK) -> None:
        while at_most > 0:
            try:
                data = os.read(descriptor, min(at_most, _CHUNK))
            except BlockingIOError:
                return
            except OSError:  # a terminal whose other side is closed
                data = b""
            if not data:
                self._close_reader(descriptor)
                return
            self._on_output(self._readers[descriptor], data)
            at_most -= len(data)

    def _close_reader(self, descriptor: int) -> None:
        if self._readers.pop(descriptor, None):
            self._loop.remove_reader(descriptor)
            os.close(descriptor)


def _signals_are_tampered() -> bool:
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    return any(each in blocked or signal.getsignal(each) is signal.SIG_IGN for each in _DEFAULT_SIGNALS)


def _set_default_signals() -> None:
    for each in _DEFAULT_SIGNALS:
        signal.signal(each, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _DEFAULT_SIGNALS)


def _member_of_group(group: int) -> int | None:
    """Return a running process of a process group, ignoring zombies."""
    for name in os.listdir("/proc"):  # noqa: PTH208
        if not name.isdigit():
            continue
        with contextlib.suppress(OSError, ValueError), open(f"/proc/{name}/stat", "rb") as file:  # noqa: PTH123
            # "pid (name) state parent group ..."; the name may contain any character.
            state, _, its_group = file.read().rpartition(b")")[2].split()[:3]
            if int(its_group) == group and state not in (b"Z", b"X"):
                return int(name)
    return None


async def _end_of(pid: int) -> None:
    """Wait until a process has ended, without reaping it."""
    loop = asyncio.get_running_loop()
    ended = loop.create_future()

    def tell() -> None:
        if not ended.done():
            ended.set_result(None)

    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return
    except (AttributeError, OSError):  # an old kernel, or a sandbox without pidfd
        threading.Thread(target=_wait_in_thread, args=(pid, loop, tell), daemon=True).start()
        await ended
        return
    try:
        loop.add_reader(descriptor, tell)
        await ended
    finally:
        loop.remove_reader(descriptor)
        os.close(descriptor)


def _wait_in_thread(pid: int, loop: asyncio.AbstractEventLoop, tell: Callable[[], None]) -> None:
    with contextlib.suppress(ChildProcessError):
        os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    with contextlib.suppress(RuntimeError):  # the loop was closed in the meantime
        loop.call_soon_threadsafe(tell)
