"""TriggeredPublisher: which messages trigger outputs, which outputs, and when."""

from __future__ import annotations

from typing import Any

import pytest

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin, world

OUTPUT = "<output type='gz.msgs.Boolean' topic='/out'>data: true</output>"


def answering(match: str = "", kind: str = "gz.msgs.Twist", more: str = OUTPUT) -> World:
    return world(plugin("TriggeredPublisher", f"<input type='{kind}' topic='/in'>{match}</input>{more}"))


def answers(node: Node, made: World, messages: list[Any]) -> list[bool]:
    """Return which of the messages were answered at once."""
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(Boolean, "/out", heard.append)
    publisher = node.advertise("/in", type(messages[0]))
    found = []
    for message in messages:
        before = len(heard)
        publisher.publish(message)
        found.append(len(heard) > before)
    return found


def twist(x: float, yaw: float = 0.0) -> Any:
    message = Twist()
    message.linear.x, message.angular.z = x, yaw
    return message


def test_without_a_match_every_message_is_answered(node: Node) -> None:
    assert answers(node, answering(), [twist(0.0), twist(1.0)]) == [True, True]


@pytest.mark.parametrize(
    ("match", "expected"),
    [
        ("<match>linear {x: 1} angular {z: 2}</match>", [False, False, True]),
        ("<match logic_type='negative'>linear {x: 1} angular {z: 2}</match>", [True, True, False]),
        ("<match field='linear.x'>1</match>", [False, True, True]),
        ("<match field='linear.x' tol='0.6'>0.5</match>", [True, True, True]),
        ("<match field='linear'>x: 1</match>", [False, True, True]),
        (
            "<match field='linear.x'>1</match><match field='angular.z' logic_type='negative'>2</match>",
            [False, True, False],
        ),
    ],
)
def test_messages_that_match(node: Node, match: str, expected: list[bool]) -> None:
    assert answers(node, answering(match), [twist(0.0), twist(1.0), twist(1.0, 2.0)]) == expected


def test_words_and_lists(node: Node) -> None:
    both = world(
        plugin(
            "TriggeredPublisher",
            f"<input type='StringMsg' topic='/in'><match field='data'>'go'</match></input>{OUTPUT}",
        )
    )
    assert answers(node, both, [StringMsg(data="stop"), StringMsg(data="go")]) == [False, True]
    assert both.warnings == []


def test_one_of_a_list_is_enough(node: Node) -> None:
    made = answering("<match field='pose'>{name: 'robot'}</match>", "gz.msgs.Pose_V")
    one, two = Pose_V(), Pose_V()
    one.pose.add(name="box")
    two.pose.add(name="box")
    two.pose.add(name="robot")
    assert answers(node, made, [one, two]) == [False, True]


def test_a_delay_is_of_simulated_time_and_ends_with_a_reset(node: Node) -> None:
    made = answering(more=OUTPUT + "<output type='gz.msgs.StringMsg' topic='/text'/><delay_ms>50</delay_ms>")
    made.attach(node)
    heard: list[int] = []
    texts: list[Any] = []
    node.subscribe(Boolean, "/out", lambda _: heard.append(made.sim_time_ns // 10**6))
    node.subscribe(StringMsg, "/text", texts.append)
    publisher = node.advertise("/in", Twist)
    publisher.publish(twist(0.0))
    made.step(20)
    publisher.publish(twist(0.0))
    made.step(100)
    assert heard == [50, 70] and len(texts) == 2
    publisher.publish(twist(0.0))
    made.reset()
    made.step(100)
    assert heard == [50, 70]


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        (OUTPUT, "needs an <input"),
        ("<input type='gz.msgs.Twist' topic='/in'/>", "at least one <output"),
        (f"<input type='gz.msgs.Twits' topic='/in'/>{OUTPUT}", "no message type 'gz.msgs.Twits'"),
        (f"<input type='gz.msgs.Twist'/>{OUTPUT}", "needs a topic"),
        (f"<input type='gz.msgs.Twist' topic='/i'><match field='linear.q'>1</match></input>{OUTPUT}", "no field 'q'"),
        (f"<input type='gz.msgs.Twist' topic='/i'><match>liner {{x: 1}}</match></input>{OUTPUT}", "does not fit"),
        (f"<input type='gz.msgs.Twist' topic='/i'><match tol='much'>a</match></input>{OUTPUT}", "tol must be a number"),
    ],
)
def test_what_does_not_fit_is_refused_at_its_line(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence) as caught:
        world(plugin("TriggeredPublisher", inside))
    assert str(caught.value).startswith("motion.sdf:")
