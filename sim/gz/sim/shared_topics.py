"""Warnings about topics that two robots or sensors of a world share: their data mix, or one command moves both.

`RunningSystems` calls `SharedTopics.check` each time systems were connected; a warning names both. Intended sharing is
not reported: transforms name their frames, joints of one model may follow one command, and a TriggeredPublisher
connects topics of others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.transport import Node

NAMED_EVERYWHERE = frozenset(("gz.msgs.Pose", "gz.msgs.Pose_V"))
"""Types whose messages name their entity, so that any system may publish on such a topic."""
NAMED_IN_A_MODEL = NAMED_EVERYWHERE | {"gz.msgs.Model", "gz.msgs.Contacts"}
"""Types whose messages name a part of a model."""
FOR_SEVERAL_JOINTS = "gz.msgs.Actuators"
ANY_TYPE = "google.protobuf.Message"
_TAGS = {
    "gz.msgs.Odometry": "odom_topic",
    "gz.msgs.OdometryWithCovariance": "odom_covariance_topic",
    "gz.msgs.CameraInfo": "camera_info_topic",
}
"""The parameter that sets the topic of each message type, if it is not `topic`."""
_MOST_NAMED = 3  # topics in one sentence


@dataclass(frozen=True, eq=False)
class Talker:
    """A system or a sensor with its node; `element` is its `<plugin>` or `<sensor>`, `shown` its name in sentences.

    `model` is empty for a system of the world; `joins` is True if it may share any topic.
    """

    system: str
    shown: str
    model: str
    element: Element
    node: Node
    joins: bool


Users = dict[str, list[tuple[Talker, str]]]
"""The users of each topic, with their message type."""
Rule = Callable[[Talker, Talker, str], bool]


class SharedTopics:
    """Checks all systems and sensors of one world; `Diagnostics` reports each sentence once."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        self._diagnostics = diagnostics

    def check(self, talkers: Iterable[Talker]) -> None:
        """Warn of the topics that two of `talkers` share."""
        published: Users = {}
        heard: Users = {}
        for talker in talkers:
            for users, ends in zip((published, heard), talker.node.endpoints(), strict=True):
                for topic, kind in ends:
                    users.setdefault(topic, []).append((talker, kind))
        self._check_types(published, heard)
        self._check_publishers(published)
        self._check_listeners(heard)

    def _check_publishers(self, published: Users) -> None:
        mixed: dict[tuple[str, str], list[tuple[Talker, Talker, str, str]]] = {}
        for first, second, kind, topic in self._pairs(published, _mix):
            # One sentence for two models: a robot that is included twice shares the topics of all its sensors.
            apart = first.model != second.model
            key = (first.model, second.model) if apart else (first.shown, second.shown)
            mixed.setdefault(key, []).append((first, second, kind, topic))
        for found in mixed.values():
            found.sort(key=lambda each: _stated(each[1].element, each[3]) is None)
            first, second, kind, topic = found[0]
            names = ", ".join(each[3] for each in found[:_MOST_NAMED])
            more = f" and {len(found) - _MOST_NAMED} more" if len(found) > _MOST_NAMED else ""
            several = len({each[1] for each in found}) > 1
            who = f"models '{first.model}' and '{second.model}'" if several else f"{first.shown} and {second.shown}"
            text = f"{who} both publish on {names}{more}, so listeners get the two mixed"
            self._warn(first, second, topic, kind, text)

    def _check_listeners(self, heard: Users) -> None:
        for first, second, kind, topic in self._pairs(heard, _both_act):
            what = "one command moves both" if first.model != second.model else "one command goes to both"
            self._warn(
                first, second, topic, kind, f"{first.shown} and {second.shown} both listen to {topic}, so {what}"
            )

    def _pairs(self, users: Users, clash: Rule) -> Iterator[tuple[Talker, Talker, str, str]]:
        """Yield at most one pair for each talker on a topic: the first talker that it conflicts with, and itself."""
        for topic, present in users.items():
            for place, (second, kind) in enumerate(present):
                for first, other in present[:place]:
                    if kind == other and not (first.joins or second.joins) and clash(first, second, kind):
                        yield first, second, kind, topic
                        break

    def _check_types(self, published: Users, heard: Users) -> None:
        for topic, publishers in published.items():
            listeners = [(talker, kind) for talker, kind in heard.get(topic, ()) if kind != ANY_TYPE]
            pairs = [(*pair, "publishes") for pair in combinations(publishers, 2)]
            pairs += [(one, other, "expects") for one in publishers for other in listeners]
            for (first, kind), (second, other), verb in pairs:
                if kind != other:
                    text = f"on {topic} {first.shown} publishes {kind}, but {second.shown} {verb} {other}"
                    self._warn(first, second, topic, other, f"{text}; a topic carries one type")
                    break

    def _warn(self, first: Talker, second: Talker, topic: str, kind: str, text: str) -> None:
        stated = _stated(second.element, topic)
        tag = stated.tag if stated is not None else _TAGS.get(kind, "topic")
        own, none = f"{topic}_2", ""
        if stated is not None and second.model:
            name = f"/{stated.text.strip('/')}"
            own = f"/model/{second.model}" + (f"/{name.rpartition('/')[2]}" if name.startswith("/model/") else name)
            if first.model != second.model:
                none = ", or none: the default one has the model's name in it"
        fix = f"give one of them a <{tag}> of its own, for example <{tag}>{own}</{tag}>{none}"
        self._diagnostics.warn((stated or second.element).where, f"{text}; {fix}")


def _mix(first: Talker, second: Talker, kind: str) -> bool:
    return kind not in (NAMED_EVERYWHERE if first.model != second.model else NAMED_IN_A_MODEL)


def _both_act(first: Talker, second: Talker, kind: str) -> bool:
    return first.model != second.model or (first.system != second.system and kind != FOR_SEVERAL_JOINTS)


def _stated(element: Element, topic: str) -> Element | None:
    """Return the element that names a topic or its prefix, as `lidar` in `/lidar/points`."""
    for child in element.children:
        name = f"/{child.text.strip('/')}" if "topic" in child.tag and child.text else ""
        if name and (name == topic or topic.startswith(f"{name}/")):
            return child
        below = _stated(child, topic)
        if below is not None:
            return below
    return None
