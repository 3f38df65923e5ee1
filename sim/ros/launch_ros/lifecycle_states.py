"""The states of lifecycle nodes, and the transitions between them, by their numbers.

Source: https://design.ros2.org/articles/node_lifecycle.html
Source: ros2/rcl_interfaces, lifecycle_msgs/msg/State.msg and Transition.msg
"""

from __future__ import annotations

from gz_course.sim.did_you_mean import did_you_mean

CONFIGURE, ACTIVATE = 1, 3
STATES = {
    0: "unknown",
    1: "unconfigured",
    2: "inactive",
    3: "active",
    4: "finalized",
    10: "configuring",
    11: "cleaningup",
    12: "shuttingdown",
    13: "activating",
    14: "deactivating",
    15: "errorprocessing",
}
TRANSITIONS = {
    0: "create",
    CONFIGURE: "configure",
    2: "cleanup",
    ACTIVATE: "activate",
    4: "deactivate",
    5: "unconfigured_shutdown",
    6: "inactive_shutdown",
    7: "active_shutdown",
    8: "destroy",
}
GOALS = {CONFIGURE: "inactive", 2: "unconfigured", ACTIVATE: "active", 4: "inactive", 5: "finalized", 6: "finalized"}
GOALS |= {7: "finalized"}
"""The state that each transition leads to if it succeeds."""


def transition_number(transition: int | str) -> int:
    """Return the number of a transition. Raises ValueError if there is none."""
    for number, name in TRANSITIONS.items():
        if transition in (number, name):
            return number
    known = did_you_mean(str(transition), TRANSITIONS.values(), listing="there are")
    raise ValueError(f"there is no transition {transition!r} of lifecycle nodes{known}")
