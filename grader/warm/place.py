"""Where a command and its helper meet: a socket in a folder that only this user can enter.

The socket's name says what both must have in common: the code and its libraries, the user and the groups, namespaces,
limits, and the variables that libraries read as they are imported. A helper of an older version, of another container
or with other limits is not found, and ends when it has been idle for long enough.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
import sys
from collections.abc import Mapping
from pathlib import Path

from gz_course.grader.process.code_stamp import code_stamp

# Variables that Python and the libraries of a grading read once, as they start.
READ_AT_IMPORT = (
    *("LD_", "LANG", "LC_", "TZ", "HOME", "MALLOC_", "GLIBC_", "PYTHON", "OMP_", "OPENBLAS_", "MKL_", "NPY_"),
    *("RMW_", "RCUTILS_", "RCL", "ROS_", "FAST", "MUJOCO_", "RERUN", "PROTOCOL_BUFFERS_", "GZ_", "ARROW_"),
)


def open_folder() -> int:
    """Return a descriptor of the folder of this user's sockets, which is made if need be.

    Raises OSError, with a sentence, if there is none that is this user's alone.
    """
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    path = Path(f"{runtime}/gz-course" if runtime.startswith("/") else f"/tmp/gz-course-{os.geteuid()}")
    with contextlib.suppress(FileExistsError):
        path.mkdir(0o700)
    folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    status = os.fstat(folder)
    if status.st_uid != os.geteuid() or stat.S_IMODE(status.st_mode) & 0o077:
        os.close(folder)
        raise PermissionError(0, "it belongs to another user, or others may enter it", str(path))
    return folder


def within(folder: int, name: str) -> Path:
    """Return a path of a file in an open folder, short enough for the address of a socket."""
    return Path(f"/proc/self/fd/{folder}/{name}")


def socket_name() -> str:
    """Return the name of the socket of the helper that does what this process would do."""
    common = (
        code_stamp(),
        [Path(each).stat().st_mtime_ns for each in sys.path if each.endswith("site-packages")],
        sys.executable,
        sys.version,
        tuple(sys.flags),
        os.getresuid(),
        os.getresgid(),
        sorted(os.getgroups()),
        sorted(str(each.readlink()) for each in Path("/proc/self/ns").iterdir()),
        Path("/proc/self/limits").read_text(),
        read_at_import(os.environ),
    )
    return hashlib.sha256(repr(common).encode()).hexdigest()[:24]


def read_at_import(environment: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the variables on which it depends what an import does.

    Of lists of folders those of this Python itself are left out: ROS adds them as Python starts, in any order.
    """
    chosen = {name: value for name, value in environment.items() if name.startswith(READ_AT_IMPORT)}
    if folders := chosen.get("LD_LIBRARY_PATH"):
        chosen["LD_LIBRARY_PATH"] = ":".join(each for each in folders.split(":") if not each.startswith(sys.prefix))
    return sorted(chosen.items())
