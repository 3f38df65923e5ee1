"""`bridged`: does the student's bridge join one topic of ROS with one of Gazebo, so that messages arrive?

kind = "bridged"
ros_topic = "/scan"
ros_type = "sensor_msgs/msg/LaserScan"
gz_topic = "/lidar"
gz_type = "gz.msgs.LaserScan"
direction = "GZ_TO_ROS"
at_least = 10             # messages that must pass
same = ["/lidar/again"]   # optional: other Gazebo topics with the same messages

No other bridge may publish the messages of another topic to the same destination.
"""

from __future__ import annotations

import re
from typing import Any

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import WAYS, Bridged, bridges
from gz_course.grader.score.launched import by_python, deaths, kept_back, logged_error, looked_elsewhere
from gz_course.sim.did_you_mean import nearest_name

KEYS = ("ros_topic", "ros_type", "gz_topic", "gz_type", "direction")
CLOCK = "/clock"
# What messages of a Gazebo type hold, in the words of a task.
CONTENTS = {
    "CameraInfo": "how a camera is built",
    "Clock": "the time",
    "Image": "pictures",
    "IMU": "turning rates and accelerations",
    "LaserScan": "scans: a distance for each ray of a lidar",
    "Model": "the state of joints",
    "Odometry": "odometry",
    "PointCloudPacked": "point clouds, the same hits of a lidar or camera as points in space",
    "Pose_V": "transforms",
    "Twist": "velocities",
}


@check_kind("bridged")
def bridged(recording: Recording, parameters: Table) -> Finding:
    """Pass if a bridge has these names, types and direction, and only its messages arrived, `at_least` of them."""
    wanted = {key: parameters.text(key) for key in KEYS[:-1]}
    wanted["direction"] = parameters.choice("direction", WAYS)
    least = parameters.number("at_least", above=0)
    same = [wanted["gz_topic"], *(parameters.texts("same") if parameters.has("same") else [])]
    facts = recording.facts()
    made = bridges(recording)
    arrow = {"GZ_TO_ROS": "<-", "ROS_TO_GZ": "->"}.get(wanted["direction"], "<->")
    expected = f"{wanted['ros_topic']} ({wanted['ros_type']}) {arrow} {wanted['gz_topic']} ({wanted['gz_type']})"
    candidates = [bridge for bridge in made if bridge.ros_topic == wanted["ros_topic"]]
    if not candidates:
        died = next((each for each in deaths(recording) if each.process == "parameter_bridge"), None)
        if died is not None and not made:
            why = died.why
            measured = f"parameter_bridge ended with exit code {died.code}{died.words}"
            return Finding(False, expected, measured, explanation=why)
        said = logged_error(recording, "parameter_bridge")
        measured = _not_there(wanted, made) + (f"; parameter_bridge said: {said}" if said else "")
        why = looked_elsewhere(said) or ("" if made or said else kept_back(recording, "bridges_made"))
        return Finding(False, expected, measured, explanation=why)
    if measured := by_python(recording, "parameter_bridge"):
        return Finding(False, expected, measured)
    faults = [_fault(bridge, wanted, same, facts, made) for bridge in candidates]
    if all(faults):
        return Finding(False, expected, faults[0])
    bridge = candidates[faults.index("")]
    went = bridge.to_ros if wanted["direction"] == "GZ_TO_ROS" else bridge.to_gz
    if went < least:
        return _too_few(expected, bridge, went, made)
    deaf = _deaf(bridge, facts) if wanted["direction"] == "GZ_TO_ROS" else ""
    wrong = deaf or _mixed(wanted, same, made)
    return Finding(not wrong, expected, wrong or f"{went} messages went through")


def _not_there(wanted: dict[str, str], made: list[Bridged]) -> str:
    """Return why there is no bridge to that ROS topic."""
    ros, gz = wanted["ros_topic"], wanted["gz_topic"]
    for bridge in made:
        if (bridge.ros_topic, bridge.gz_topic) == (gz, ros):
            return f"{bridge.place}: the names are the wrong way round: {gz} is Gazebo's name, {ros} is that of ROS"
        if bridge.gz_topic == gz:
            return f"{bridge.place}: Gazebo's {gz} is called {bridge.ros_topic} in ROS here; the node uses {ros}"
    near = nearest_name(ros, [bridge.ros_topic for bridge in made], 0.8)
    return f"no bridge has the ROS topic {ros}" + (f"; is it '{near}'?" if near else "")


def _fault(bridge: Bridged, wanted: dict[str, str], same: list[str], facts: dict[str, Any], made: list[Bridged]) -> str:
    """Return what is wrong with a bridge to the right ROS topic; empty if nothing is."""
    if bridge.gz_topic not in same:
        wrong = _wrong_gz_topic(bridge, wanted, facts.get("gz_topics", {}))
        return f"{bridge.place}: {wrong}{_of_another(bridge, wanted, made)}"
    if bridge.ros_type != wanted["ros_type"]:
        return f"{bridge.place}: {bridge.ros_topic} is {bridge.ros_type} here, but the node uses {wanted['ros_type']}"
    if bridge.gz_type != wanted["gz_type"]:
        return f"{bridge.place}: {bridge.gz_topic} is {bridge.gz_type} here, but in Gazebo it is {wanted['gz_type']}"
    if bridge.direction == wanted["direction"]:
        return ""
    if bridge.direction == "BIDIRECTIONAL":
        return f"{bridge.place}: {bridge.ros_topic} goes both ways (no direction means that); one way is right"
    return f"{bridge.place}: {bridge.ros_topic} goes the wrong way, {bridge.direction}: {_why(wanted)}"


def _of_another(bridge: Bridged, wanted: dict[str, str], made: list[Bridged]) -> str:
    """Return which other bridge has the Gazebo topic that belongs here, or the one that stands here; else nothing."""
    for other in made:
        if other.gz_topic == wanted["gz_topic"] and other.ros_topic != bridge.ros_topic:
            return f"; the one that does stands in the entry of {other.ros_topic} ({other.place})"
    for other in made:
        if other.gz_topic == bridge.gz_topic and other.ros_topic != bridge.ros_topic:
            return f"; the entry of {other.ros_topic} ({other.place}) has it, too"
    return ""


def _wrong_gz_topic(bridge: Bridged, wanted: dict[str, str], gz: dict[str, Any]) -> str:
    kind = "subscribers" if wanted["direction"] == "ROS_TO_GZ" else "publishers"
    does = "listens to" if wanted["direction"] == "ROS_TO_GZ" else "publishes"
    if match := re.fullmatch(rf"/world/([^/]+){re.escape(wanted['gz_topic'])}", bridge.gz_topic):
        return (
            f"the Gazebo topic {bridge.gz_topic} exists only in the world called {match[1]}, and so not with another "
            f"world file; {wanted['gz_topic']} exists in every world"
        )
    if "gz sim" in gz.get(bridge.gz_topic, {}).get(kind, []):
        carried = (gz[bridge.gz_topic].get("types") or [""])[0]
        what, other = (CONTENTS.get(name.rpartition(".")[2], "") for name in (carried, wanted["gz_type"]))
        said = f": it carries {what}, and {bridge.ros_topic} is to carry {other}" if what and other != what else ""
        model, mine = _model(bridge.gz_topic), _model(wanted["gz_topic"])
        said = said or (
            f": it is that of the model {model}, not of {mine}" if model and mine not in ("", model) else ""
        )
        return f"{bridge.gz_topic} is not the Gazebo topic that belongs to {bridge.ros_topic}{said}"
    if bridge.gz_topic.endswith((",", ";")):
        end = bridge.gz_topic[-1]
        return f"nobody in Gazebo {does} {bridge.gz_topic}: in YAML, the {end} at the end is a part of the name"
    near = nearest_name(bridge.gz_topic, [wanted["gz_topic"]], 0.9)
    typo = "it is nearly right, look at its spelling: " if near else ""
    name = ", which is its name in ROS" if bridge.gz_topic == wanted["ros_topic"] else ""
    if not gz and not typo and not name and does == "publishes":  # of a launch, Gazebo's graph is not known
        return (
            f"{bridge.gz_topic} is not the Gazebo topic that belongs to {bridge.ros_topic}; gz topic -l lists the "
            "topics there are, and gz topic -i -t NAME says what a topic carries"
        )
    return f"nobody in Gazebo {does} {bridge.gz_topic}{name}; {typo}gz topic -l lists the topics there are"


def _model(topic: str) -> str:
    """Return the model whose name is in the name of a Gazebo topic; empty if none is."""
    match = re.match(r"/model/([^/]+)/", topic)
    return match[1] if match else ""


def _why(wanted: dict[str, str]) -> str:
    if wanted["direction"] == "ROS_TO_GZ":
        return "commands come from ROS, and Gazebo listens"
    return "Gazebo publishes it, and ROS listens"


def _too_few(expected: str, bridge: Bridged, went: int, made: list[Bridged]) -> Finding:
    """Return the finding that too few messages passed a correctly configured bridge, with the reason."""
    clock = any(b.ros_topic == CLOCK and b.to_ros for b in made)
    if bridge.direction == "ROS_TO_GZ" and not clock:
        measured = f"{went} messages went through: the node waits for {CLOCK}, which does not arrive"
        return Finding(False, expected, measured, gated=True)
    return Finding(False, expected, f"{bridge.place}: only {went} messages went through")


def _mixed(wanted: dict[str, str], same: list[str], made: list[Bridged]) -> str:
    """Return which other bridge publishes messages of another topic to the same one; empty if none does."""
    ros, gz = wanted["ros_topic"], wanted["gz_topic"]
    for bridge in made:
        if (
            wanted["direction"] != "ROS_TO_GZ"
            and bridge.to_ros
            and bridge.ros_topic == ros
            and bridge.gz_topic not in same
        ):
            return f"{bridge.place}: {bridge.gz_topic} arrives on {ros}, too: a subscription there receives both, mixed"
        if wanted["direction"] != "GZ_TO_ROS" and bridge.to_gz and bridge.gz_topic == gz and bridge.ros_topic != ros:
            return f"{bridge.place}: {bridge.ros_topic} goes to {gz}, too: whatever subscribes there obeys both"
    return ""


def _deaf(bridge: Bridged, facts: dict[str, Any]) -> str:
    """Return why the subscribing node receives nothing; empty if it does."""
    offer = bridge.publisher_qos
    for end in facts.get("endpoints", []):
        if (end["kind"], end["topic"]) != ("subscription", bridge.ros_topic) or offer is None:
            continue
        for policy, weak in (("reliability", "BEST_EFFORT"), ("durability", "VOLATILE")):
            asked, offered = end[policy], getattr(offer, policy)
            if asked not in (weak, "SYSTEM_DEFAULT", "BEST_AVAILABLE") and offered == weak:
                return (
                    f"{bridge.place}: {bridge.ros_topic} is offered with the {policy} {offered}, but the node asks for "
                    f"{asked}: it hears nothing"
                )
    return ""
