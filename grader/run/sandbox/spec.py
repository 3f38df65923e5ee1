"""The specification of a sandbox: filled in by `Sandbox`, carried out by a file of `levels/` and by `init/main.py`."""

from __future__ import annotations

import marshal
import resource
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from gz_course.grader.run.sandbox.view import Place

# One rclpy node needs about 600 MB of address space, 16 threads and 18 files.
LIMITS = {
    resource.RLIMIT_AS: 4 << 30,
    resource.RLIMIT_NOFILE: 256,
    resource.RLIMIT_CORE: 0,
    resource.RLIMIT_FSIZE: 256 << 20,
}
MOST_PROCESSES = 256  # and threads
HOST = "course"  # host name in a sandbox
# Devices that a submission without a file system of its own may write to, and folders it may read.
OPEN_DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")
OPEN_FOLDERS = ("/proc", "/sys/devices/system/cpu", "/dev/fd", "/etc/passwd", "/etc/group", "/etc/hosts")


@dataclass(frozen=True)
class SandboxSpec:
    """Everything about one sandbox. `user` and `group` are None if it keeps the grader's."""

    walls: str
    places: tuple[Place, ...]
    root: str  # an empty folder to build in
    host: str
    user: int | None
    group: int | None
    landlock: bool
    tcp: bool  # whether Landlock, which cannot tell loopback from other networks, allows TCP
    seccomp: bool
    limits: dict[int, int]
    readable: tuple[str, ...]
    writable: tuple[str, ...]
    folder: str  # working directory of the submission
    command: list[str]
    environment: dict[str, str]
    descriptors: tuple[int, ...]

    def as_bytes(self) -> bytes:
        """Encode it for `init/main.py`, which is run by the same Python."""
        return marshal.dumps(asdict(self))

    def for_init(self) -> SandboxSpec:
        """Return only what `init/main.py` needs, without the mounts that bubblewrap makes."""
        places = self.places if self.walls == "own" else tuple(p for p in self.places if p.kind == "tmpfs")
        return replace(self, places=places)


def init_command(channel: int) -> list[str]:
    """Return the command that starts `init/main.py`, which reads its order from the socket `channel`."""
    start = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); from init.main import main; main()"
    return [sys.executable, "-I", "-S", "-c", start, str(channel)]
