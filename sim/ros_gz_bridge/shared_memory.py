"""Room in shared memory for pictures: DDS's own is half a megabyte, and larger messages are lost in it.

Fast DDS sends to nodes of the same machine through a segment of shared memory of the sender. A camera's picture does
not fit into the one it makes by default: a best-effort subscriber then gets nothing, a reliable one only what is sent
again, tens of milliseconds late. ``ros_program`` gives programs that send pictures a larger one; whoever receives needs
no change. Where the user has set up DDS otherwise, that counts.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

SEGMENT_BYTES = 32 * 1024 * 1024
"""Five pictures of 1920x1080 on their way; a segment takes up that much memory from the start."""
_FOLDER = Path("/dev/shm")
_SHARE = 8
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
        <transport_id>room_for_pictures</transport_id>
        <type>SHM</type>
        <segment_size>{size}</segment_size>
      </transport_descriptor>
      <transport_descriptor>
        <transport_id>network</transport_id>
        <type>UDPv4</type>
      </transport_descriptor>
    </transport_descriptors>
    <participant profile_name="room_for_pictures" is_default_profile="true">
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
def room_for_pictures() -> Iterator[None]:
    """Nodes that are created inside get a segment of ``SEGMENT_BYTES``, if it fits and the user has not chosen."""
    if _is_set_up(os.environ) or _free_bytes() < _SHARE * SEGMENT_BYTES:
        yield
        return
    with contextlib.ExitStack() as stack:
        try:
            file = stack.enter_context(tempfile.NamedTemporaryFile("w", prefix="room_for_pictures-", suffix=".xml"))
            file.write(profile(os.environ))
            file.flush()
        except OSError:  # nowhere to write: DDS's own has to do
            yield
            return
        os.environ[_SETTING] = os.environ[_NEWER_SETTING] = file.name
        try:
            yield
        finally:
            os.environ.pop(_SETTING, None)
            os.environ.pop(_NEWER_SETTING, None)


def profile(environment: Mapping[str, str]) -> str:
    """The settings for Fast DDS as it reads them."""
    only_here = (
        environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper() == "LOCALHOST"
        or environment.get("ROS_LOCALHOST_ONLY", "") == "1"
    )
    # For nodes that stay on this machine ROS adds transports of its own, the network's with narrower bounds.
    transports = ["room_for_pictures"] if only_here else ["room_for_pictures", "network"]
    lines = [f"          <transport_id>{each}</transport_id>" for each in transports]
    return _PROFILE.format(size=SEGMENT_BYTES, transports="\n".join(lines))


def _is_set_up(environment: Mapping[str, str]) -> bool:
    """Whether the user has chosen how DDS sends, or another middleware."""
    return (
        environment.get("RMW_IMPLEMENTATION", "") not in _FAST_DDS
        or any(environment.get(name) for name in (_SETTING, _NEWER_SETTING, "FASTDDS_BUILTIN_TRANSPORTS"))
        or any(Path(name).exists() for name in _FILES)
    )


def _free_bytes() -> int:
    try:
        free = os.statvfs(_FOLDER)
    except OSError:  # no shared memory: DDS goes through the network
        return 0
    return free.f_bavail * free.f_frsize
