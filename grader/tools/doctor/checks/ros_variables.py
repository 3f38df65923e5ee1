"""Do the ROS 2 variables of this shell let nodes started by hand find each other?

Grading sets its own variables and does not depend on them.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine, warning
from gz_course.sim.foreign_variables import MIDDLEWARE

TITLE = "ROS 2 variables"
LARGEST_DOMAIN = 232  # DDS computes its UDP ports from it: 7400 + 250 * domain + ... must not exceed 65535
LARGEST_SAFE_DOMAIN = 101  # above it the ports are ephemeral ones, which Linux gives to any outgoing connection
RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")
PROFILES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")


def examine(probes: Probes) -> Verdict:
    return judge(os.environ)


def judge(environment: Mapping[str, str]) -> Verdict:
    """Return the verdict on an environment's variables; the worst problem first."""
    domain = environment.get("ROS_DOMAIN_ID", "").strip() or "0"
    middleware = environment.get("RMW_IMPLEMENTATION", "")
    discovery = environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "")
    if not (domain.isascii() and domain.isdigit() and int(domain[:9]) <= LARGEST_DOMAIN):
        return failed(f"ROS_DOMAIN_ID is {domain!r}", "set it to a whole number from 0 to 101, or unset it")
    if middleware not in ("", MIDDLEWARE):
        return failed(
            f"RMW_IMPLEMENTATION is {middleware!r}, which the ROS wheels do not bring",
            f"`unset RMW_IMPLEMENTATION` ({MIDDLEWARE} is then taken)",
        )
    for name in PROFILES:
        if (profile := environment.get(name)) and not Path(profile).is_file():
            return failed(f"{name} names no file: {profile}", f"`unset {name}`, or give the right path")
    if discovery not in ("", *RANGES):
        return failed(
            f"ROS_AUTOMATIC_DISCOVERY_RANGE is {discovery!r}, which ROS 2 does not know",
            f"set it to one of {', '.join(RANGES)}, or unset it",
        )
    if discovery == "OFF":
        return warning(
            "ROS_AUTOMATIC_DISCOVERY_RANGE is OFF: nodes started by hand do not find each other",
            "`unset ROS_AUTOMATIC_DISCOVERY_RANGE`, or set it to LOCALHOST",
        )
    if int(domain) > LARGEST_SAFE_DOMAIN:
        return warning(
            f"ROS_DOMAIN_ID is {domain}: its ports are also used for outgoing connections",
            f"take a domain from 0 to {LARGEST_SAFE_DOMAIN}",
        )
    return fine(f"domain {domain}, {middleware or MIDDLEWARE}, discovery {discovery or 'SUBNET'}")
