"""The environment variables of a run: for the grader's own ROS context and for the submission's processes."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from gz_course.sim.foreign_variables import MIDDLEWARE

KEPT_VARIABLES = ("PATH", "LANG", "LC_ALL", "TZ", "SSL_CERT_FILE")
# Set by the ROS wheels when they restart Python; one without the other breaks `import rclpy`.
WHEEL_VARIABLES = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH")
# Beginnings of the names of the variables that ROS and Fast DDS read.
OF_ROS = ("ROS_", "RMW_", "RCL_", "RCUTILS_", "FASTDDS_", "FASTRTPS_", "SKIP_DEFAULT_XML")
PROFILES = Path(__file__).parents[1] / "agent" / "fastdds"
CONSOLE_FORMAT = "[{severity}] [{name}]: {message}"  # no wall-clock stamp, so that the same run gives the same lines


@contextmanager
def in_force(values: Mapping[str, str]) -> Iterator[None]:
    """Set the environment variables of this process that ROS and DDS read, and no other of theirs; DDS reads them when
    its context is made.

    A discovery server, a profile or another middleware of the caller's would keep nodes from seeing each other.
    """
    others = [key for key in os.environ if key.startswith(OF_ROS) and key not in values]
    before = {key: os.environ.get(key) for key in (*values, *others)}
    for key in others:
        del os.environ[key]
    os.environ.update(values)
    try:
        yield
    finally:
        for key, value in before.items():
            if value is None:
                os.environ.pop(key, None)
            else:
                os.environ[key] = value


def ros_environment(domain: int, log_dir: Path) -> dict[str, str]:
    """Return the variables that keep one run's ROS graph on this machine and in its own domain."""
    return {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "RMW_IMPLEMENTATION": MIDDLEWARE,
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "ROS_LOG_DIR": str(log_dir),
    }


def box_environment(domain: int, log_dir: Path, private_network: bool) -> dict[str, str]:
    """Return `ros_environment` for both sides of a sandbox: UDP on loopback only.

    With LOCALHOST, rmw_fastrtps also uses shared memory, whatever FASTDDS_BUILTIN_TRANSPORTS says. A sandbox has a
    shared memory of its own, so nothing would arrive; and without one, segments stay behind when a process is killed. A
    private network has only a loopback; in the machine's network, a profile of Fast DDS restricts it to loopback. Both
    announce often.
    """
    profile = PROFILES / ("private.xml" if private_network else "loopback.xml")
    values = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "FASTRTPS_DEFAULT_PROFILES_FILE": str(profile)}
    return ros_environment(domain, log_dir) | values


def student_environment(domain: int, home: Path, private_network: bool) -> dict[str, str]:
    """Return the whole environment of a submission's process whose home is the folder `home`."""
    kept = {k: os.environ[k] for k in KEPT_VARIABLES if k in os.environ}
    # The course's programs and Python come first, whatever the caller has sourced.
    kept["PATH"] = os.pathsep.join([os.path.dirname(sys.executable), kept.get("PATH", os.defpath)])  # noqa: PTH120
    if all(k in os.environ for k in WHEEL_VARIABLES):
        kept |= {k: os.environ[k] for k in WHEEL_VARIABLES}
    return (
        kept
        | box_environment(domain, home / "log", private_network)
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
            "GZ_PARTITION": f"student-{domain}",
        }
    )
