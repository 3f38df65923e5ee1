"""What is on record of the submission's endpoints: what DDS shows, and of what was only reported nothing."""

import dataclasses

import pytest

from gz_course.grader.run import endpoint_facts
from gz_course.grader.run.discovery import UNKNOWN
from gz_course.grader.run.endpoint_facts import EndpointFacts
from gz_course.grader.run.fair_clock import FairClock
from gz_course.grader.run.processes.progress import Endpoint

SCAN = Endpoint("/a", "subscription", "/scan", "sensor_msgs/msg/LaserScan", "BEST_EFFORT", "VOLATILE", 0)
DRIVE = Endpoint("/a", "publisher", "/cmd_vel", "geometry_msgs/msg/Twist", "RELIABLE", "VOLATILE", 1)


class Seen:
    """What DDS shows, one answer after the other; the last stays."""

    def __init__(self, *answers):
        self.answers = list(answers)

    def endpoints(self):
        return iter(self.answers.pop(0) if len(self.answers) > 1 else self.answers[0])


@pytest.fixture
def facts(monkeypatch):
    """Facts of what was reported and is still `present`, when DDS shows this."""
    monkeypatch.setattr(endpoint_facts, "NAMES", 0.0)

    def call(reported, *answers, present=(), reliably=False):
        made = EndpointFacts(Seen(*answers), lambda topic: reliably)
        made.report(reported)
        made.close(present, FairClock(list), lambda: None)
        return [(each["node"], each["topic"], each["reliability"]) for each in made.as_facts()]

    return call


def test_what_nobody_has_reported_is_there_all_the_same(facts):
    assert facts([], [DRIVE]) == [("/a", "/cmd_vel", "RELIABLE")]


def test_what_is_reported_to_the_end_and_not_there_is_left_out(facts):
    assert facts([DRIVE, SCAN], [SCAN], present=[DRIVE, SCAN]) == [("/a", "/scan", "BEST_EFFORT")]


def test_what_has_gone_with_its_process_stays_on_record(facts):
    assert facts([DRIVE], [], present=[]) == [("/a", "/cmd_vel", "RELIABLE")]


def test_the_quality_of_service_is_that_of_dds_except_where_the_agent_asks_for_more(facts):
    really = dataclasses.replace(SCAN, reliability="RELIABLE")
    assert facts([SCAN], [really]) == [("/a", "/scan", "RELIABLE")]
    assert facts([SCAN], [really], reliably=True) == [("/a", "/scan", "BEST_EFFORT")]


def test_an_endpoint_whose_node_stays_unknown_belongs_to_none(facts):
    assert facts([], [dataclasses.replace(DRIVE, node=UNKNOWN)]) == []


def test_topics_of_every_node_are_not_waited_for():
    made = EndpointFacts(Seen([DRIVE]), lambda topic: False)
    every = dataclasses.replace(DRIVE, topic="/parameter_events")
    made.report([DRIVE, every])
    made.close([DRIVE, every], FairClock(list), lambda: pytest.fail("nothing is missing"))
    assert [each["topic"] for each in made.as_facts()] == ["/cmd_vel"]
