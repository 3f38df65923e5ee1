"""The sandbox ("box") of one run: created, filled with `put_files`, started with `start`, and closed.

Used by `grader.run.session`, and by `probe.py` to find out which level works here.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import resource
import socket
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.run.sandbox.environment import box_environment, student_environment
from gz_course.grader.run.sandbox.init import seccomp
from gz_course.grader.run.sandbox.level import AUTO, LEVELS, choose, level_module
from gz_course.grader.run.sandbox.network import NetworkError, PrivateNetwork
from gz_course.grader.run.sandbox.resource_monitor import ResourceMonitor, descendants
from gz_course.grader.run.sandbox.sandboxed_process import SandboxedProcess
from gz_course.grader.run.sandbox.spec import (
    HOST,
    LIMITS,
    MOST_PROCESSES,
    OPEN_DEVICES,
    OPEN_FOLDERS,
    SandboxSpec,
    init_command,
)
from gz_course.grader.run.sandbox.view import HOME, SOCKETS, SUBMISSION, TMP_FILES, TMP_SIZE, readable, view

PR_SET_CHILD_SUBREAPER = 36
FIRST_USER = 61_000  # + the ROS domain: unused by others, and different for simultaneous runs
BESIDE = 200  # between the user of a submission's sandbox and that of the one beside it


def enter_early(level: str) -> None:
    """Enter a private network for good if `level` has one, in a command that does nothing but grade.

    Only needed by ordinary users, who can enter it only before any thread exists. A failure is reported when a sandbox
    is made.
    """
    if level_module(level).PRIVATE_NETWORK and os.geteuid() != 0:
        with contextlib.suppress(NetworkError):
            PrivateNetwork()


class Sandbox:
    """One sandbox, and the private network that its processes share with the grader's ROS side.

    `level` is `A` to `D`, or `auto` for the best that works in this process. `close()` removes everything. Raises
    InfrastructureError if the level asked for is not available.

    A sandbox `beside` another one has its level and its network, and nothing else in common with it: files, processes,
    shared memory, limits and, where there are users, the user are its own. Only what the exercise brings runs there.
    """

    def __init__(self, domain: int, level: str = AUTO, beside: Sandbox | None = None) -> None:
        self._beside = beside is not None
        self.level: str = beside.level if beside is not None else choose() if level == AUTO else level
        self._module = level_module(self.level)
        if lack := self._module.missing():
            raise InfrastructureError(f"no sandbox of level {self.level} here: {lack}")
        self.domain = domain
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # makes orphaned daemons children of this process
        self._network: PrivateNetwork | None = None
        if self._module.PRIVATE_NETWORK and beside is None:  # else this process is in it already
            try:
                self._network = PrivateNetwork()
            except NetworkError as error:
                if level != AUTO:
                    raise InfrastructureError(f"no sandbox of level {level} here: {error}") from None
                # A process that cannot enter a private network (any more) takes the best level without one.
                self.level = next(each for each in LEVELS if not level_module(each).PRIVATE_NETWORK)
                self._module = level_module(self.level)
        self._temporary = TemporaryFolder("course-")
        self.folder = self._temporary.path
        for name in ("submission", "home", "door", "root", "etc"):
            (self.folder / name).mkdir()
            (self.folder / name).chmod(0o755)
        self._boxes: list[SandboxedProcess] = []

    def grader_environment(self) -> dict[str, str]:
        """Return the variables that the grader's own ROS context needs."""
        return box_environment(self.domain, self.folder / "grader-log", self._module.PRIVATE_NETWORK)

    def student_environment(self) -> dict[str, str]:
        """Return the whole environment of the submission's process."""
        return student_environment(self.domain, self.home, self._module.PRIVATE_NETWORK)

    @property
    def home(self) -> Path:
        """The submission's working folder, as seen in the sandbox."""
        return HOME if self._module.NAMESPACES else self.folder / "home"

    def put_files(self, files: Mapping[str, bytes]) -> Path:
        """Put files (by relative name, with `/` between parts) into the sandbox; return the folder as seen inside."""
        folder = self.folder / "submission"
        for name, data in files.items():
            path = folder / name
            for parent in reversed(path.relative_to(folder).parents[:-1]):
                (folder / parent).mkdir(exist_ok=True)
                (folder / parent).chmod(0o755)
            path.write_bytes(data)
            path.chmod(0o644)
        return SUBMISSION if self._module.NAMESPACES else folder

    @property
    def socket_folder(self) -> tuple[Path, Path]:
        """The folder for the grader's unix sockets: its path outside (to bind) and inside (to connect)."""
        outside = self.folder / "door"
        return outside, SOCKETS if self._module.NAMESPACES else outside

    def start(
        self, command: Sequence[str], environment: Mapping[str, str], pass_fds: Sequence[int] = ()
    ) -> SandboxedProcess:
        """Start a command in the sandbox, in its own process group, with stdout and stderr as pipes.

        `command` begins with the path of a program; `environment` is added to `student_environment()`; `pass_fds` keep
        their numbers. If the sandbox cannot be built, waiting for the process raises InfrastructureError.
        """
        before = frozenset(descendants(os.getpid()))
        spec = self._spec(list(command), self.student_environment() | dict(environment), tuple(pass_fds))
        if not (self._module.NAMESPACES or self._module.LANDLOCK):
            boxed = SandboxedProcess(
                _spawn(spec.command, spec.environment, self.home, pass_fds), self.level, None, False
            )
            with contextlib.suppress(ProcessLookupError):
                limit(boxed.pid)
        else:
            ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            with theirs:
                ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
                line = self._module.command(spec, init_command(theirs.fileno()))
                process = _spawn(line, {"PATH": os.defpath}, Path("/"), (theirs.fileno(), *pass_fds))
            boxed = SandboxedProcess(process, self.level, ours, bool(self._module.NAMESPACES))
            with contextlib.suppress(OSError):  # it has ended already; its end is reported by `wait`
                ours.send(spec.for_init().as_bytes())
        self._boxes.append(boxed)
        if self._module.NAMESPACES or self._beside:  # the processes in the sandbox are below its outermost one
            boxed.monitor = ResourceMonitor(boxed.pid, boxed.kill)
        else:
            # Its log lies in its home, too, and may be as long as any file.
            most = TMP_SIZE + LIMITS[resource.RLIMIT_FSIZE]
            boxed.monitor = ResourceMonitor(os.getpid(), boxed.kill, before, self.home, most, TMP_FILES)
        return boxed

    def _spec(self, command: list[str], environment: dict[str, str], descriptors: tuple[int, ...]) -> SandboxSpec:
        walls, landlock = self._module.NAMESPACES, self._module.LANDLOCK
        own_user = bool(walls) and os.geteuid() == 0
        user = FIRST_USER + BESIDE * self._beside + self.domain if own_user else None
        places = (
            tuple(view(self.folder / "submission", self.folder / "door", self._etc(user))) if walls or landlock else ()
        )
        writable = [place.path for place in places if place.kind == "tmpfs"] if walls else [str(self.home)]
        limits = {int(kind): most for kind, most in LIMITS.items()}
        if walls:  # without namespaces the limit counts all processes of the user
            limits[int(resource.RLIMIT_NPROC)] = MOST_PROCESSES
        return SandboxSpec(
            walls=walls,
            places=places,
            root=str(self.folder / "root"),
            host=HOST,
            user=user,
            group=user,
            landlock=landlock,
            tcp=self._module.PRIVATE_NETWORK,
            seccomp=(landlock or bool(walls)) and seccomp.supported(),
            limits=limits,
            readable=("/",) if walls else (*readable(places), *OPEN_FOLDERS),
            writable=(*writable, *OPEN_DEVICES),
            folder=str(self.home),
            command=command,
            environment=environment,
            descriptors=descriptors,
        )

    def _etc(self, user: int | None) -> Path:
        """Return a folder with the files of /etc a program may read: its user, and where host names come from."""
        etc = self.folder / "etc"
        number, group = (os.geteuid(), os.getegid()) if user is None else (user, user)
        for name, text in {
            "passwd": f"student:x:{number}:{group}::{HOME}:/bin/sh\n",
            "group": f"student:x:{group}:\n",
            "hosts": f"127.0.0.1 localhost {HOST}\n::1 localhost\n",
            "nsswitch.conf": "passwd: files\ngroup: files\nhosts: files\n",
        }.items():
            (etc / name).write_text(text)
            (etc / name).chmod(0o644)
        return etc

    def close(self) -> None:
        """End what still runs, leave the private network, remove the folder and everything in it."""
        for boxed in self._boxes:
            if boxed.running:
                boxed.kill()
            boxed.close()
        self._temporary.close()
        if self._network is not None:
            self._network.close()


def limit(pid: int) -> None:
    """Set the resource limits of a process that was just started."""
    for kind, most in LIMITS.items():
        hard = resource.prlimit(pid, kind)[1]
        value = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.prlimit(pid, kind, (value, value))


def _spawn(
    command: Sequence[str], environment: Mapping[str, str], folder: Path, pass_fds: Sequence[int]
) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        list(command),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=dict(environment),
        cwd=folder,
        pass_fds=tuple(pass_fds),
        start_new_session=True,
    )
