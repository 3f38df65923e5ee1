"""The first program inside a sandbox: restricts itself, starts the submission, and ends when it ends.

`grader.run.sandbox` starts it as a script with the number of a socket, over which it gets its order. With namespaces it
stays as process 1, reaps orphans, forwards signals and reports how the submission ended; when it ends, Linux ends
everything in the sandbox. Without namespaces it becomes the submission.
"""

from __future__ import annotations

# The C modules behind `signal` and `socket`, which would take longer to import than everything else here.
import _signal as signal  # type: ignore[import-not-found]
import marshal
import os
import resource
import select
import sys
from _socket import AF_UNIX, SOCK_STREAM, socket, socketpair

from . import kernel, landlock, namespaces, seccomp

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, NoReturn

LARGEST = 1 << 20  # [bytes] of a message
FAILED = 125  # exit code of a sandbox that could not be built


def main() -> None:
    """Read the order from the socket named in argv[1] and carry it out."""
    channel = socket(fileno=int(sys.argv[1]))
    os.set_inheritable(channel.fileno(), False)
    try:
        order = marshal.loads(channel.recv(LARGEST))
        kernel.prctl(kernel.PR_SET_PDEATHSIG, signal.SIGKILL)
        if order["walls"] == "own":
            namespaces.build(order["root"], order["host"], order["places"])
        elif order["walls"]:
            namespaces.restrict_mounts(order["places"])
        if order["walls"]:
            _supervise(order, channel)
        _become(order)
    except (OSError, ValueError, KeyError, EOFError) as error:
        _tell(channel, "error", error)
        os._exit(FAILED)


def _become(order: dict[str, Any]) -> NoReturn:
    """Restrict this process and execute the submission in it."""
    os.chdir(order["folder"])
    for number, most in order["limits"].items():
        hard = resource.getrlimit(int(number))[1]
        value = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(int(number), (value, value))
    kernel.drop_capabilities(order["user"], order["group"])
    kernel.prctl(kernel.PR_SET_PDEATHSIG, signal.SIGKILL)  # the change of user has reset it
    kernel.prctl(kernel.PR_SET_NO_NEW_PRIVS, 1)
    if order["landlock"]:
        landlock.restrict(order["readable"], order["writable"], tcp=order["tcp"])
    if order["seccomp"]:
        seccomp.install()
    for number in (signal.SIGINT, signal.SIGPIPE, signal.SIGXFSZ):  # restore the defaults that any program expects
        signal.signal(number, signal.SIG_DFL)
    os.execve(order["command"][0], order["command"], order["environment"])


def _supervise(order: dict[str, Any], channel: socket) -> NoReturn:
    """Start the submission and stay until it ends or the grader is gone."""
    wake, woken = socketpair(AF_UNIX, SOCK_STREAM)
    for end in (wake, woken):
        end.setblocking(False)
        os.set_inheritable(end.fileno(), False)
    signal.set_wakeup_fd(woken.fileno(), warn_on_full_buffer=False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    child = os.fork()
    if not child:
        try:
            signal.set_wakeup_fd(-1)
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            os.setsid()
            _become(order)
        except OSError as error:
            _tell(channel, "error", error)
        finally:
            os._exit(FAILED)
    _tell(channel, "begun", child)
    kernel.drop_capabilities(order["user"], order["group"])
    kernel.prctl(kernel.PR_SET_PDEATHSIG, signal.SIGKILL)
    kernel.prctl(kernel.PR_SET_DUMPABLE, 0)  # nobody in the sandbox may trace this process
    for number in (0, 1, 2, *order["descriptors"]):
        os.close(number)
    while True:
        ready, _, _ = select.select([channel, wake], [], [])
        if wake in ready:
            try:  # noqa: SIM105 - contextlib takes its time, too
                wake.recv(4096)
            except BlockingIOError:
                pass
            _collect(child, channel)
        if channel in ready:
            told = channel.recv(16)
            if not told:
                os._exit(0)
            try:  # noqa: SIM105
                os.killpg(child, told[0])
            except (ProcessLookupError, PermissionError):
                pass


def _collect(child: int, channel: socket) -> None:
    """Reap every process that has ended; exit when the submission has."""
    while True:
        try:
            ended, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if not ended:
            return
        if ended == child:
            _tell(channel, "exit", os.waitstatus_to_exitcode(status))
            os._exit(0)


def _tell(channel: socket, what: str, value: Any) -> None:
    """Report that the submission was started, its exit code, or why there is no sandbox."""
    try:  # noqa: SIM105
        channel.send(f"{what} {value}".encode(errors="replace"))
    except OSError:
        pass  # the grader is gone, so this process ends soon


if __name__ == "__main__":
    main()
