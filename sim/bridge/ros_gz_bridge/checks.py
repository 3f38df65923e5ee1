"""Checks of configured bridges: faults, and settings with an unexpected effect.

`config` and `arguments` call `check`, so `lint` and a starting `parameter_bridge` report the same. A check is a
function marked with `@_check`; it gets all entries together and yields a `Finding` for each fault.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence

from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction, ServiceEntry
from gz_course.sim.bridge.ros_gz_bridge.finding import Finding

_Check = Callable[[Sequence[BridgeEntry], Sequence[ServiceEntry]], Iterator[Finding]]
_checks: list[_Check] = []

_CLOCK = "rosgraph_msgs/msg/Clock"
_TF = "tf2_msgs/msg/TFMessage"
_SENSORS = ("BatteryState", "CameraInfo", "Contacts", "FluidPressure", "IMU", "Image", "LaserScan", "Magnetometer")
_STATES = ("Clock", "Model", "NavSat", "Odometry", "OdometryWithCovariance", "PointCloudPacked")
_PUBLISHED_BY_GAZEBO = {f"gz.msgs.{name}" for name in (*_SENSORS, *_STATES)}
_COMMANDS = re.compile(r"(^|[/_])cmd_(vel|pos|force|thrust|effort)$|/(enable|joint_trajectory)$")
_WITHOUT_HEADER = {"builtin_interfaces", "rosgraph_msgs", "std_msgs", "rcl_interfaces", "tf2_msgs"}
_PARTS = ("Point", "Pose", "Quaternion", "Transform", "Twist", "Vector3", "Wrench")
_HEADERLESS = {f"geometry_msgs/msg/{name}" for name in (*_PARTS, "PoseWithCovariance", "TwistWithCovariance")}


def check(topics: Iterable[BridgeEntry], services: Iterable[ServiceEntry] = ()) -> Iterator[Finding]:
    """Yield the findings of all checks, in the order of the entries."""
    topics, services = list(topics), list(services)
    sources = [entry.source for entry in topics] + [entry.source for entry in services]
    order = {source: number for number, source in enumerate(sources)}
    found = [finding for look in _checks for finding in look(topics, services)]
    yield from sorted(found, key=lambda finding: order.get(finding.place, len(order)))


def _check(function: _Check) -> _Check:
    _checks.append(function)
    return function


def _warning(entry: BridgeEntry, sentence: str) -> Finding:
    return Finding(entry.source, sentence, warning=True)


def _advice(entry: BridgeEntry, sentence: str) -> Finding:
    return Finding(entry.source, sentence, warning=True, advice=True)


def _never(entry: BridgeEntry, sentence: str) -> Finding:
    """Return an error about a bridge that never carries a useful message; the original ros_gz_bridge makes it."""
    return Finding(entry.source, sentence, tolerated=True)


@_check
def _repeated(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report entries that bridge the same message on the same route twice."""
    seen: dict[tuple[str, ...], BridgeEntry] = {}
    for entry in topics:
        for way, used in (("ros", entry.direction.to_ros), ("gz", entry.direction.to_gz)):
            first = seen.setdefault((way, *entry.same_route), entry) if used else entry
            if first is not entry:
                yield _warning(entry, f"bridges {entry.ros_topic} again (first: {first.source}); keep one")
                break
    names: dict[str, ServiceEntry] = {}
    for service in services:
        first_service = names.setdefault(service.name, service)
        if first_service is not service:
            yield Finding(service.source, f"offers {service.name} again (first: {first_service.source}); keep one")


@_check
def _two_types_on_one_topic(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report a topic with two types: a subscriber receives messages of its own type only."""
    first_ros: dict[str, BridgeEntry] = {}
    first_gz: dict[str, BridgeEntry] = {}
    for entry in topics:
        other = first_ros.setdefault(entry.ros_topic, entry)
        if other.ros_type != entry.ros_type:
            yield Finding(
                entry.source,
                f"{entry.ros_topic} is {entry.ros_type} here and {other.ros_type} in {other.source}; a ROS topic has "
                "one type, give one of the two another ros_topic_name",
            )
        other = first_gz.setdefault(entry.gz_topic, entry)
        if other.gz_type != entry.gz_type:
            yield Finding(
                entry.source,
                f"the Gazebo topic {entry.gz_topic} is {entry.gz_type} here and {other.gz_type} in {other.source}; "
                "a subscriber of one type receives no messages of the other",
                warning=not (other.direction.to_gz and entry.direction.to_gz),
            )


@_check
def _clock_to_gazebo(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report a bridge of the clock to Gazebo: it advertises the topic, and Gazebo then publishes no clock on it."""
    for entry in topics:
        if entry.ros_type == _CLOCK and entry.direction is Direction.ROS_TO_GZ:
            yield _never(
                entry,
                f"gives Gazebo a clock on {entry.gz_topic}, but Gazebo makes its own time and listens to no clock; "
                "did you mean [ or direction: GZ_TO_ROS?",
            )
        elif entry.ros_type == _CLOCK and entry.direction is Direction.BIDIRECTIONAL:
            yield _warning(
                entry,
                f"publishes {entry.gz_topic} in Gazebo too, and Gazebo then keeps its own clock off that topic; "
                "bridge a clock from Gazebo to ROS only ([ or direction: GZ_TO_ROS)",
            )


@_check
def _clock_name(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report a clock on a topic other than /clock, and two clocks on /clock."""
    clocks = [entry for entry in topics if entry.ros_type == _CLOCK and entry.direction.to_ros]
    on_the_topic = [entry for entry in clocks if entry.ros_topic.strip("/") == "clock"]
    if clocks and not on_the_topic:
        yield _warning(
            clocks[0],
            f"the clock arrives on {clocks[0].ros_topic}, but nodes with use_sim_time listen to /clock; give it "
            "ros_topic_name: /clock (on the command line: -r NAME:=/clock)",
        )
    for entry in on_the_topic[1:]:
        first = on_the_topic[0]
        if first.gz_topic != entry.gz_topic:
            yield _warning(
                entry,
                f"a second clock on {entry.ros_topic} (first: {first.source}); time would jump back and forth",
            )


@_check
def _wrong_direction(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report sensors bridged to Gazebo and commands bridged from Gazebo."""
    for entry in topics:
        if entry.ros_type == _CLOCK:
            continue
        published = entry.gz_type in _PUBLISHED_BY_GAZEBO
        if published and entry.direction is Direction.ROS_TO_GZ:
            yield _never(
                entry,
                f"{entry.gz_type} is what Gazebo publishes, nothing in its world listens to that; "
                "did you mean [ or direction: GZ_TO_ROS?",
            )
        elif published and entry.direction is Direction.BIDIRECTIONAL:
            yield _warning(
                entry,
                f"{entry.gz_type} is what Gazebo publishes, nothing in its world listens to that; [ or direction: "
                "GZ_TO_ROS is enough (without a direction a bridge goes both ways)",
            )
        elif entry.direction is Direction.GZ_TO_ROS and _COMMANDS.search(entry.gz_topic):
            yield _warning(
                entry,
                f"{entry.gz_topic} is where Gazebo listens for commands, it publishes none; "
                "did you mean ] or direction: ROS_TO_GZ?",
            )


@_check
def _poses_without_frames(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report a bridge of the poses of the scene to transforms, because these poses have no frames."""
    for entry in topics:
        if entry.ros_type == _TF and entry.direction.to_ros and entry.gz_topic.endswith("pose/info"):
            yield _warning(
                entry,
                f"the poses of {entry.gz_topic} carry no frames, so every transform has an empty frame_id; bridge "
                "/model/NAME/tf (DiffDrive) or /model/NAME/pose (PosePublisher, OdometryPublisher)",
            )


@_check
def _lazy_commands(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report lazy bridges to Gazebo: they save no computation and lose the first command."""
    for entry in topics:
        if entry.lazy and entry.direction is Direction.ROS_TO_GZ:
            yield _advice(
                entry,
                "a lazy bridge to Gazebo saves nothing and loses the commands sent before it connects; "
                "leave lazy out here",
            )
        elif entry.lazy and entry.direction is Direction.BIDIRECTIONAL:
            yield _advice(
                entry,
                "a lazy bridge that goes both ways counts itself as a listener in the original and never disconnects; "
                "give it one direction",
            )


@_check
def _frame_id_without_header(topics: Sequence[BridgeEntry], services: Sequence[ServiceEntry]) -> Iterator[Finding]:
    """Report `frame_id` for messages without a header."""
    for entry in topics:
        of_package = entry.ros_type.split("/")[0] in _WITHOUT_HEADER and entry.ros_type != "std_msgs/msg/Header"
        headerless = entry.ros_type in _HEADERLESS or of_package
        if entry.frame_id and entry.direction.to_ros and headerless:
            yield _advice(entry, f"'frame_id' changes nothing here: {entry.ros_type} has no header")


def private_gz_names(topics: Iterable[BridgeEntry], services: Iterable[ServiceEntry]) -> Iterator[Finding]:
    """Yield an error for each Gazebo name with `~`, which requires the parameter `expand_gz_topic_names`.

    It is not one of the checks, because only the caller knows the parameter.
    """
    names = [(entry.source, entry.gz_topic) for entry in topics]
    names += [(entry.source, entry.gz_service) for entry in services]
    for source, name in names:
        if name.startswith("~"):
            yield Finding(source, f"the Gazebo name {name} works only with the parameter expand_gz_topic_names:=true")


def volatile_static_transforms(topics: Iterable[BridgeEntry]) -> Iterator[Finding]:
    """Yield a warning for each bridge to /tf_static without a QoS of its own: listeners of tf2 receive nothing from it.

    It is not one of the checks, because only the caller knows parameters and remappings.
    """
    for entry in topics:
        to_listeners = entry.ros_type == _TF and entry.direction.to_ros and entry.ros_topic.endswith("tf_static")
        if to_listeners and entry.qos_profile is None:
            yield _warning(
                entry,
                f"listeners of transforms ask {entry.ros_topic} for transient_local and receive nothing from this "
                f"bridge; add -p qos_overrides.{entry.ros_topic}.publisher.durability:=transient_local",
            )
