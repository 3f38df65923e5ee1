"""Stamps of another clock than `/clock`: use_sim_time was forgotten, or the stamp was never set."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

BEFORE = ("nobody_publishes",)
FAR = 10.0  # [s]


def look(system: System) -> Iterator[Finding]:
    """Find messages whose stamp differs much from `/clock` at their arrival."""
    if not system.ros.clock:
        return
    sim_time = {node.name: node.use_sim_time for node in system.ros.nodes}
    for topic, heard in sorted(system.ros.heard.items()):
        for each in heard.messages:
            header = getattr(each.message, "header", None)
            clock_ns = each.clock_ns if each.clock_ns is not None else system.ros.clock[0][1]
            if header is None:
                break
            stamp = header.stamp.sec + header.stamp.nanosec * 1e-9
            if abs(stamp - clock_ns * 1e-9) <= FAR and not (stamp == 0.0 and clock_ns > 10**9):
                continue
            senders = [end.node for end in system.ros_ends(topic, publish=True)]
            if stamp == 0.0:
                sentence, fix = f"Messages on {topic} from {names(senders)} have no stamp.", "Set header.stamp from "
                fix += "self.get_clock().now().to_msg()."
            else:
                sentence = (
                    f"Messages on {topic} from {names(senders)} are stamped {stamp:.1f} s while /clock says "
                    f"{clock_ns * 1e-9:.1f} s: subscribers that match stamps drop them."
                )
                fix = "Start the node that stamps them with --ros-args -p use_sim_time:=true"
            evidence = tuple(
                f"{node}: use_sim_time is {str(sim_time.get(node)).lower()}" for node in sorted(set(senders))
            )
            yield Finding(Severity.ERROR, sentence, fix, evidence)
            break
