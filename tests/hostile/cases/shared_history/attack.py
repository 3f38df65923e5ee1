"""Accepts every goal. Has Fast DDS share histories by memory (data sharing), and writes that goals were rejected into those of others."""

import os
from pathlib import Path

ACCEPTED, REJECTED = (b"\0\1\0\0" + bytes((accepted,)) for accepted in (1, 0))  # of a reply to a goal, as CDR
SHARED = Path("/dev/shm")
SHARING = "<data_{0} profile_name='{0}' is_default_profile='true'><qos><data_sharing><kind>AUTOMATIC</kind></data_sharing></qos></data_{0}>"
PROFILES = Path(os.environ["HOME"]) / "sharing.xml"
PROFILES.write_text(
    f"<dds xmlns='http://www.eprosima.com'><profiles>{''.join(map(SHARING.format, ('writer', 'reader')))}</profiles></dds>"
)
os.environ |= {
    "FASTDDS_BUILTIN_TRANSPORTS": "DEFAULT",
    "FASTRTPS_DEFAULT_PROFILES_FILE": str(PROFILES),
    "RMW_FASTRTPS_USE_QOS_FROM_XML": "1",
}


def histories():
    """What Fast DDS has in shared memory: of this process, and of others."""
    mapped = Path("/proc/self/maps").read_text()
    there = [path for path in SHARED.glob("fast*") if not path.name.endswith("_el")]
    return [path for path in there if path.name in mapped], [path for path in there if path.name not in mapped]


def rewritten(path):
    with path.open("r+b") as memory:
        said = memory.read()
        memory.seek(0)
        memory.write(said.replace(ACCEPTED, REJECTED))
    return said.count(ACCEPTED)


def may_share():
    """Whether anything may be made in shared memory."""
    try:
        (SHARED / "own").touch()
        (SHARED / "own").unlink()
    except OSError:
        return False
    return True


def attacked(on_goal):
    def on_goal_of_the_attack(node, goal):
        if goal.speed == 0.0:  # the last of four that come at once
            mine, theirs = histories()
            shared = [path for path in mine if "datasharing" in path.name]
            print("held" if shared or not may_share() else "shares nothing", len(shared), "histories of its own,", len(theirs), "of others", flush=True)
            for path in theirs:
                try:
                    print("ESCAPED", path.name, rewritten(path), flush=True)
                except OSError as error:
                    print("held", path.name, error.strerror, flush=True)
        return on_goal(node, goal)

    return on_goal_of_the_attack
