"""The node's log as reports show it: its beginning and its end."""

import pytest

from gz_course.grader.report.node_log import FIRST, LAST, node_log


def made(record, count, **facts):
    return record(lines=[(i / 100, f"line {i}") for i in range(count)], facts=facts)


def test_a_short_log_is_whole(record):
    log = node_log(made(record, 3))
    assert [text for _, _, text in log.first] == ["line 0", "line 1", "line 2"]
    assert (log.left_out, log.last, log.dropped) == (0, (), 0)
    assert log.as_text().splitlines()[1] == "    0.01 s  line 1"


@pytest.mark.parametrize("count", [FIRST + LAST, FIRST + LAST + 1, 1000])
def test_a_long_one_loses_its_middle(record, count):
    log = node_log(made(record, count, lines_dropped=5))
    kept = [text for _, _, text in log.first + log.last]
    assert len(kept) + log.left_out == count
    assert (kept[0], kept[-1]) == ("line 0", f"line {count - 1}")
    assert ("left out" in log.as_text()) == (count > FIRST + LAST)
    assert log.as_text().endswith("(5 more lines are not recorded: the log is too long)")


def test_only_its_end(record):
    log = node_log(made(record, 10), 0, 2)
    assert (log.first, log.left_out, [text for _, _, text in log.last]) == ((), 8, ["line 8", "line 9"])


def test_control_codes_and_endless_lines(record):
    log = node_log(record(lines=[(0.5, "a\x1b[2Jb\0"), (0.6, "x" * 5000)]))
    assert all(c.isprintable() for _, _, text in log.first for c in text)
    assert len(log.first[1][2]) < 500


@pytest.mark.parametrize(
    ("log", "facts", "who"),
    [
        ("log/student", {}, "your node"),
        ("log/student", {"launch": {}}, "your launch file's programs"),
        ("log/given_node", {"given": True}, "the exercise's own node"),
    ],
)
def test_a_log_is_named_by_who_wrote_it(record, log, facts, who):
    said = node_log(record(lines=[(0.5, "on patrol")], log=log, facts=facts))
    assert (said.who, [text for _, _, text in said.first]) == (who, ["on patrol"])


def test_no_log_at_all(record):
    assert node_log(record()).as_text() == ""
