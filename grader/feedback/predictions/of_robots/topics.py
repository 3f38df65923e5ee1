"""Names on the two sides of a bridge that do not meet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.graphs import Bridged
from gz_course.grader.score.robots import Robot


@guarded("")
def topic_of(text: str, default: str) -> str:
    """Return the topic that Gazebo makes of the text of a `<topic>`: absolute, with underscores for blanks."""
    name = text.strip().replace(" ", "_").strip("/")
    return f"/{name}" if name else default


@guarded("")
def heard_elsewhere(who: str, topic: str, bridge: Bridged) -> str:
    """Say that plugin or sensor and the bridge use different Gazebo topics."""
    return (
        f"{who} {topic} (its <topic>), and the bridge has {bridge.gz_topic} for {bridge.ros_topic}: one name is wrong"
    )


@guarded("")
def why_not_carried(
    made: Iterable[Bridged],
    topic: str,
    kind: str,
    to_gz: bool,
    said: str = "",
    remapped: Iterable[Mapping[str, Any]] = (),
) -> str:
    """Return why no bridge carries the ROS topic `topic` of the type `kind` in this direction; empty if one does.

    `said` is an error of the bridge's program, `remapped` are the remappings of the launch file.
    """
    every = list(made)
    mine = [bridge for bridge in every if bridge.ros_topic == topic]
    if not mine:
        other = next((each for each in every if each.ros_type == kind and each.ros_topic != topic), None)
        if kind in said:
            return f"the bridge left it out: {said}"
        if other is None:
            return f"no bridge has the ROS topic {topic}"
        wrong = next((each for each in remapped if (each["from"], each["to"]) == (topic, other.ros_topic)), None)
        if wrong is not None:
            return (
                f"no bridge has the ROS topic {topic}: {wrong['file']}, line {wrong['line']}, has the two names of the "
                f"remapping exchanged: the old one comes first, ('{other.ros_topic}', '{topic}')"
            )
        if other.ros_topic == other.gz_topic:
            return (
                f"no bridge has the ROS topic {topic}; {other.place} is called {other.ros_topic} in ROS, as in Gazebo: "
                f"a remapping to {topic} is missing, or its two names are exchanged: (from, to)"
            )
        return f"{other.place}: it is called {other.ros_topic} in ROS, not {topic}"
    bridge = mine[0]
    if bridge.ros_type != kind:
        return f"{bridge.place}: {topic} is {bridge.ros_type} here, not {kind}"
    if to_gz and bridge.direction == "GZ_TO_ROS":
        return f"{bridge.place}: {topic} goes the wrong way, from Gazebo to ROS ([): commands go to Gazebo, so it is ]"
    if not to_gz and bridge.direction == "ROS_TO_GZ":
        return f"{bridge.place}: {topic} goes the wrong way, from ROS to Gazebo (]): Gazebo publishes it, so it is ["
    return ""


@guarded("")
def commands_elsewhere(robot: Robot, made: Iterable[Bridged], topic: str) -> str:
    """Return that the bridge takes commands to another Gazebo topic than the one DiffDrive listens to."""
    plugins = robot.systems("DiffDrive")
    bridge = next((each for each in made if each.ros_topic == topic and each.direction != "GZ_TO_ROS"), None)
    if bridge is None or len(plugins) != 1:
        return ""
    listens = topic_of(plugins[0].text("topic"), f"/model/{robot.name}/cmd_vel")
    return "" if listens == bridge.gz_topic else heard_elsewhere("DiffDrive listens to", listens, bridge)


@guarded("")
def no_joint_states(robot: Robot, bridge: Bridged) -> str:
    """Return why nothing publishes joint states on the Gazebo topic of a bridge."""
    plugins = robot.systems("JointStatePublisher")
    if not plugins:
        return "the robot has no plugin gz::sim::systems::JointStatePublisher (gz-sim-joint-state-publisher-system)"
    topics = [topic_of(plugin.text("topic"), "") for plugin in plugins]
    if not topics[0]:
        return (
            f"its JointStatePublisher has no <topic>, so it publishes on /world/WORLD/model/{robot.name}/joint_state, "
            f"and the bridge has {bridge.gz_topic}"
        )
    return "" if bridge.gz_topic in topics else heard_elsewhere("JointStatePublisher publishes on", topics[0], bridge)


@guarded("")
def few_joints(robot: Robot) -> str:
    """Return that JointStatePublisher names only some of the joints."""
    for plugin in robot.systems("JointStatePublisher"):
        named = plugin.all("joint_name")
        if named:
            return (
                f"its JointStatePublisher names only {', '.join(named)} (<joint_name>); without that it publishes all"
            )
    moving = [joint.name for joint in robot.joints if joint.kind != "fixed"]
    return f"of its joints only {', '.join(moving) or 'none'} can move: a wheel's joint is of type continuous"
