"""Statistics of topics: what is counted, how it is published, and what ordinary processes have."""

import statistics
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, TopicStatistics, datagram
from gz_course.sim.gz.transport.environment import NetworkSettings
from gz_course.sim.gz.transport.topic_statistics import RunningStatistic, StatisticsTable, now_ms


@given(st.lists(st.floats(-1e6, 1e6), min_size=1))
def test_a_running_statistic_is_that_of_the_list(values):
    running = RunningStatistic()
    for value in values:
        running.add(value)
    assert (running.count, running.least, running.greatest) == (len(values), min(values), max(values))
    assert running.mean == pytest.approx(statistics.fmean(values), abs=1e-6)
    assert running.deviation == pytest.approx(statistics.pstdev(values), rel=1e-6, abs=1e-3)


def test_what_is_counted_and_published():
    counted = TopicStatistics()
    for number, stamp, arrived in ((0, 1000, 1002), (1, 1100, 1103), (4, 1400, 1401)):
        counted.update(b"one", stamp, number, arrived)
    counted.update(b"two", 5000, 77, 5004)  # another publisher: neither a loss nor a period
    assert counted.dropped_message_count == 2
    metric = counted.message()
    assert metric.unit == "milliseconds"
    assert [(each.name, each.value) for each in metric.statistics] == [("dropped_message_count", 2.0)]
    groups = {group.name: {each.name: each.value for each in group.statistics} for group in metric.statistics_groups}
    assert groups["publication_statistics"] == {
        "avg_hz": 5.0, "min_period": 100.0, "max_period": 300.0, "period_standard_devation": 100.0,
    }  # fmt: skip
    assert groups["reception_statistics"]["min_period"] == 101.0
    ages = groups["age_statistics"]
    assert (ages["avg_age"], ages["min_age"], ages["max_age"]) == (2.5, 1.0, 4.0)


def test_only_enabled_topics_and_whole_stamps_are_counted():
    table, told = StatisticsTable(), []
    stamp = struct.pack("<QQ", now_ms(), 0)
    table.record("@/p@/a", b"one", stamp)
    table.enable("@/p@/a", told.append)
    table.record("@/p@/a", b"one", b"short")
    assert table.get("@/p@/a") is None
    table.record("@/p@/a", b"one", stamp)
    assert table.get("@/p@/a").age.count == len(told) == 1
    table.disable("@/p@/a")
    assert table.get("@/p@/a") is None


def test_the_calls_of_the_official_binding():
    with Node() as node, Node() as other:
        node.subscribe(StringMsg, "/chat", print)
        assert node.enable_stats("/chat", True, "/statistics", 1) is True
        assert [each.msg_type_name for each in other.topic_info("/statistics")[0]] == ["gz.msgs.Metric"]
        assert node.topic_stats("/chat") is None
        assert node.enable_stats("/chat", False) is True
        assert "/statistics" not in node.advertised_topics()
        assert node.enable_stats("/a b", True) is False


def test_processes_with_statistics_have_a_version_of_their_own():
    with_them = NetworkSettings.from_environment({"GZ_TRANSPORT_TOPIC_STATISTICS": "1"})
    assert with_them.topic_statistics
    data = datagram.encode(Discovery(version=110, process_uuid="x"))
    assert datagram.decode(data) is None
    assert datagram.decode(data, datagram.STATISTICS_VERSION).process_uuid == "x"


def test_statistics_between_processes(start_peer):
    """A process that measures another one; both have the variable, so this process does not see them."""
    sender = start_peer(GZ_TRANSPORT_TOPIC_STATISTICS="1")
    listener = start_peer(GZ_TRANSPORT_TOPIC_STATISTICS="1")
    listener.ask("measure", topic="/chat")
    sender.ask("advertise", topic="/chat")
    assert sender.ask("wait", topic="/chat")
    for number in range(3):
        sender.ask("publish", topic="/chat", text=str(number))
    listener.heard(3)
    age, dropped = listener.ask("measured", topic="/chat")
    assert (age, dropped) == (3, 0)
