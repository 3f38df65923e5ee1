"""Fast DDS settings for programs that send images: a segment of shared memory that holds them.

Fast DDS sends to nodes of the same machine through a segment of shared memory of the sender, by default half a
megabyte. A larger message does not fit: a best-effort subscriber gets nothing, a reliable one only what is sent again,
tens of milliseconds late. Receivers need no change. Settings of the user take precedence.

Source: XML profiles of Fast DDS, https://fast-dds.docs.eprosima.com/en/2.14.x/fastdds/transport/shared_memory/shared_memory.html
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from gz_course.sim.ros.ros_program.abandoned_segments import FOLDER, remove_abandoned_segments

SEGMENT_BYTES = 32 * 1024 * 1024
"""Size of the segment [byte], enough for five images of 1920x1080. The memory is used from the start."""
_SHARE = 8  # maximum share of a segment in the free shared memory: one eighth
_SETTING = "FASTRTPS_DEFAULT_PROFILES_FILE"
_NEWER_SETTING = "FASTDDS_DEFAULT_PROFILES_FILE"
_FILES = ("DEFAULT_FASTRTPS_PROFILES.xml", "DEFAULT_FASTDDS_PROFILES.xml")
_FAST_DDS = ("", "rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp")
_PROFILE = """\
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <profiles>
    <transport_descriptors>
      <transport_descriptor>
        <transport_id>segment_for_images</transport_id>
        <type>SHM</type>
        <segment_size>{size}</segment_size>
      </transport_descriptor>
      <transport_descriptor>
        <transport_id>network</transport_id>
        <type>UDPv4</type>
      </transport_descriptor>
    </transport_descriptors>
    <participant profile_name="segment_for_images" is_default_profile="true">
      <rtps>
        <userTransports>
{transports}
        </userTransports>
        <useBuiltinTransports>false</useBuiltinTransports>
      </rtps>
    </participant>
  </profiles>
</dds>
"""


@contextlib.contextmanager
def segment_for_images() -> Iterator[None]:
    """Give nodes that are created inside a segment of `SEGMENT_BYTES`, if it fits and the user has not set up DDS.

    The segments of killed processes are removed first.
    """
    remove_abandoned_segments()
    if _is_set_up(os.environ) or _free_bytes() < _SHARE * SEGMENT_BYTES:
        yield
        return
    with contextlib.ExitStack() as stack:
        try:
            file = stack.enter_context(tempfile.NamedTemporaryFile("w", prefix="segment_for_images-", suffix=".xml"))
            file.write(profile(os.environ))
            file.flush()
        except OSError:  # no writable folder: keep the default segment
            yield
            return
        os.environ[_SETTING] = os.environ[_NEWER_SETTING] = file.name
        try:
            yield
        finally:
            os.environ.pop(_SETTING, None)
            os.environ.pop(_NEWER_SETTING, None)


def profile(environment: Mapping[str, str]) -> str:
    """Return the XML profile for Fast DDS."""
    only_here = (
        environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper() == "LOCALHOST"
        or environment.get("ROS_LOCALHOST_ONLY", "") == "1"
    )
    # For nodes that stay on this machine rmw_fastrtps adds a UDP transport of its own, bound to the loopback.
    transports = ["segment_for_images"] if only_here else ["segment_for_images", "network"]
    lines = [f"          <transport_id>{each}</transport_id>" for each in transports]
    return _PROFILE.format(size=SEGMENT_BYTES, transports="\n".join(lines))


def _is_set_up(environment: Mapping[str, str]) -> bool:
    """Return whether the user has set up the transports of DDS or chosen another middleware."""
    return (
        environment.get("RMW_IMPLEMENTATION", "") not in _FAST_DDS
        or any(environment.get(name) for name in (_SETTING, _NEWER_SETTING, "FASTDDS_BUILTIN_TRANSPORTS"))
        or any(Path(name).exists() for name in _FILES)
    )


def _free_bytes() -> int:
    try:
        free = os.statvfs(FOLDER)
    except OSError:  # no shared memory: DDS uses the network
        return 0
    return free.f_bavail * free.f_frsize
