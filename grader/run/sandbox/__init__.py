"""The box a submission runs in: a cleared environment, a private folder, limits, its own ROS domain.

Level D: resource limits, a process group of its own, and a sweep for daemons when the run ends. The network is
the machine's loopback, kept apart by the ROS domain. The level stands in every report.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import resource
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

LEVEL = "D"
PR_SET_CHILD_SUBREAPER = 36
# One rclpy node needs about 600 MB of address space, 16 threads and 18 files.
LIMITS = {
    resource.RLIMIT_AS: 4 << 30,
    resource.RLIMIT_NOFILE: 256,
    resource.RLIMIT_CORE: 0,
    resource.RLIMIT_FSIZE: 256 << 20,
}
KEPT_VARIABLES = ("PATH", "LANG", "LC_ALL", "TZ", "SSL_CERT_FILE")
# Set by the ROS wheels when they restart Python; one without the other breaks `import rclpy`.
WHEEL_VARIABLES = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH")
CONSOLE_FORMAT = "[{severity}] [{name}]: {message}"  # no wall-clock stamp: the same run gives the same lines


def ros_environment(domain: int, log_dir: Path) -> dict[str, str]:
    """Environment variables that keep one run's ROS graph on loopback, in its own domain, without shared memory.

    Fast DDS's shared-memory transport leaves segments behind when a process is killed, hence UDP.
    """
    return {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "ROS_LOG_DIR": str(log_dir),
    }


class Sandbox:
    """A private folder and the environment for one run; `close()` removes the folder."""

    level = LEVEL

    def __init__(self, domain: int, level: str = "auto") -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="course-"))
        self.domain = domain
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # orphaned daemons become ours to sweep

    def grader_environment(self) -> dict[str, str]:
        """What the grader's own ROS context needs."""
        return ros_environment(self.domain, self.folder / "grader-log")

    def student_environment(self) -> dict[str, str]:
        """The whole environment of the submission's process."""
        kept = {k: os.environ[k] for k in KEPT_VARIABLES if k in os.environ}
        if all(k in os.environ for k in WHEEL_VARIABLES):
            kept |= {k: os.environ[k] for k in WHEEL_VARIABLES}
        home = self.home
        return (
            kept
            | ros_environment(self.domain, home / "log")
            | {
                "HOME": str(home),
                "TMPDIR": str(home),
                "PYTHONUNBUFFERED": "1",
                "PYTHONDONTWRITEBYTECODE": "1",
                "PYTHONHASHSEED": "0",
                "OPENBLAS_NUM_THREADS": "1",
                "RCUTILS_CONSOLE_OUTPUT_FORMAT": CONSOLE_FORMAT,
                "RCUTILS_COLORIZED_OUTPUT": "0",
                "GZ_IP": "127.0.0.1",
                "GZ_PARTITION": f"student-{self.domain}",
            }
        )

    @property
    def home(self) -> Path:
        """The submission's working folder."""
        home = self.folder / "home"
        home.mkdir(exist_ok=True)
        return home

    def stage(self, files: Mapping[str, bytes]) -> Path:
        """Put files (by name, relative, with `/` between parts) into the box; the folder as the box sees it."""
        folder = self.folder / "submission"
        for name, data in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        return folder

    def start(
        self, command: Sequence[str], environment: Mapping[str, str], pass_fds: Sequence[int] = ()
    ) -> subprocess.Popen[bytes]:
        """Start a command in the box, in a process group of its own, with stdout and stderr as pipes.

        `environment` is added to `student_environment()`; `pass_fds` keep their numbers.
        """
        process = subprocess.Popen(
            list(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=self.student_environment() | dict(environment),
            cwd=self.home,
            pass_fds=tuple(pass_fds),
            start_new_session=True,
        )
        with contextlib.suppress(ProcessLookupError):
            self.limit(process.pid)
        return process

    def limit(self, pid: int) -> None:
        """Put the resource limits on a process that was just started."""
        for kind, most in LIMITS.items():
            hard = resource.prlimit(pid, kind)[1]
            value = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.prlimit(pid, kind, (value, value))

    def close(self) -> None:
        """Remove the folder and everything in it."""
        shutil.rmtree(self.folder, ignore_errors=True)
