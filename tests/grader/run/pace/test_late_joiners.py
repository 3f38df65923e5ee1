"""Kept messages that DDS hands over: each pair of endpoints counts once, when both are there."""

from types import SimpleNamespace

from gz_course.grader.run.agent.course_agent.history import History
from gz_course.grader.run.pace.late_joiners import LateJoiners
from gz_course.grader.run.processes.progress import Progress

KEY = "/kept gz_course/msg/Progress"


def process(number, kept=0, asked=0, kind="x/msg/Y"):
    key = f"/kept {kind}"
    report = Progress(kept={key: kept} if kept is not None else {}, asked={key: asked} if asked else {})
    return SimpleNamespace(number=number, progress=report)


def test_what_is_kept_when_a_subscription_comes_is_due():
    late = LateJoiners()
    late.look([process(0, 3), process(1, None)])
    assert late.due == {}
    late.look([process(0, 4), process(1, None, 1)])
    late.look([process(0, 9), process(1, None, 1)])
    assert late.due == {"/kept": 4}
    late.look([process(0, 9), process(1, None, 2)])  # a second one
    assert late.due == {"/kept": 13}


def test_what_is_published_to_subscriptions_that_are_there_is_not_due_again():
    late = LateJoiners()
    late.look([process(0, 0), process(1, None, 1)])
    late.look([process(0, 5), process(1, None, 1), process(2, None)])
    assert late.due == {"/kept": 0}


def test_what_came_before_the_publisher_was_seen_is_due_to_all():
    late = LateJoiners()
    late.look([process(1, None, 2)])
    late.look([process(0, 1), process(1, None, 2)])
    assert late.due == {"/kept": 2}


def test_what_the_bridge_keeps_is_due_to_those_who_come_later():
    late = LateJoiners()
    late.look([process(0, None, 1)], {"/kept x/msg/Y": 0})
    late.look([process(0, None, 1)], {"/kept x/msg/Y": 5})
    assert late.due["/kept"] == 0  # it heard each when it was sent
    late.look([process(0, None, 1), process(1, None, 1)], {"/kept x/msg/Y": 7, "/other x/msg/Y": 9})
    assert late.due == {"/kept": 7}


def test_subscriptions_of_another_type_get_nothing():
    late = LateJoiners()
    late.look([process(0, 3), process(1, None, 1, kind="x/msg/Z")])
    assert late.due == {}


def qos(durability="TRANSIENT_LOCAL", reliability="RELIABLE", history="KEEP_LAST", depth=2):
    named = {"durability": durability, "reliability": reliability, "history": history}
    return SimpleNamespace(depth=depth, **{key: SimpleNamespace(name=value) for key, value in named.items()})


def test_a_publisher_keeps_as_many_as_its_depth():
    def endpoint(**of):
        return SimpleNamespace(topic="/kept", msg_type=Progress, qos_profile=qos(**of))

    publisher, plain, asking = endpoint(), endpoint(durability="VOLATILE"), endpoint(history="KEEP_ALL")
    history = History(lambda endpoint: endpoint.topic)
    nodes = [
        SimpleNamespace(publishers=[publisher, plain], subscriptions=[asking, endpoint(reliability="BEST_EFFORT")])
    ]
    history.look(nodes)
    assert history.report() == {"kept": {KEY: 0}, "asked": {KEY: 1}}
    for _ in range(5):
        history.count(publisher)
        history.count(plain)
    assert history.report()["kept"] == {KEY: 2}
    history.look(nodes)
    assert history.report()["kept"] == {KEY: 2}
