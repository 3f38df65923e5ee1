"""The environment variables of a run: the grader's own ROS context, and everything a submission gets to see."""

from __future__ import annotations

import os
from pathlib import Path

KEPT_VARIABLES = ("PATH", "LANG", "LC_ALL", "TZ", "SSL_CERT_FILE")
# Set by the ROS wheels when they restart Python; one without the other breaks `import rclpy`.
WHEEL_VARIABLES = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH")
CONSOLE_FORMAT = "[{severity}] [{name}]: {message}"  # no wall-clock stamp: the same run gives the same lines


def ros_environment(domain: int, log_dir: Path, private_network: bool = False) -> dict[str, str]:
    """Environment variables that keep one run's ROS graph on loopback and in its own domain.

    In a private network there is nothing but a loopback, so discovery need not be told to stay there. It must not:
    asked for LOCALHOST, Fast DDS prefers shared memory whatever FASTDDS_BUILTIN_TRANSPORTS says, and a box has its own.
    """
    return {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET" if private_network else "LOCALHOST",
        "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "ROS_LOG_DIR": str(log_dir),
    }


def student_environment(domain: int, home: Path, private_network: bool) -> dict[str, str]:
    """Return the whole environment of a submission's process that lives in the folder `home`."""
    kept = {k: os.environ[k] for k in KEPT_VARIABLES if k in os.environ}
    if all(k in os.environ for k in WHEEL_VARIABLES):
        kept |= {k: os.environ[k] for k in WHEEL_VARIABLES}
    return (
        kept
        | ros_environment(domain, home / "log", private_network)
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
