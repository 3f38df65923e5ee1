"""Deadlines with their time zones, and how late is late."""

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.lateness import UNKNOWN, lateness, read_deadline


@pytest.mark.parametrize(
    ("text", "utc"),
    [
        ("2026-11-20 23:59 Europe/Berlin", "2026-11-20 22:59"),
        ("2026-07-20 23:59 Europe/Berlin", "2026-07-20 21:59"),
        ("2026-11-20T23:59+01:00", "2026-11-20 22:59"),
        ("2026-11-20T22:59Z", "2026-11-20 22:59"),
        ("2026-11-20 22:59 UTC", "2026-11-20 22:59"),
        ("2026-10-25 02:30 Europe/Berlin", "2026-10-25 01:30"),  # comes twice: the later one
    ],
)
def test_a_deadline(text, utc):
    assert read_deadline(text).astimezone(UTC).replace(tzinfo=None) == datetime.fromisoformat(utc)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("2026-11-20 23:59", "no time zone"),
        ("2026-11-20", "no time of the day"),
        ("tomorrow", "is no time"),
        ("20.11.2026 23:59 Europe/Berlin", "is no time"),
        ("2026-11-20 23:59 Mars/Olympus", "no time zone 'Mars/Olympus'"),
        ("2026-03-29 02:30 Europe/Berlin", "is skipped"),
    ],
)
def test_what_is_no_deadline(text, words):
    with pytest.raises(UsageError, match=words):
        read_deadline(text)


DUE = read_deadline("2026-11-20 23:59 Europe/Berlin")


@pytest.mark.parametrize(
    ("submitted", "cell"),
    [
        ("2026-11-20T22:59:00+00:00", ""),
        ("2026-11-20T22:59:01+00:00", "LATE by 1 s"),
        ("2026-11-20T23:59:00", ""),  # in the deadline's zone
        ("2026-11-22T01:04:30", "LATE by 1 d 1 h 5 min"),
        ("0001-01-01T00:00:00", ""),
    ],
)
def test_how_late(submitted, cell):
    assert lateness(DUE, datetime.fromisoformat(submitted)) == cell


def test_without_a_time_nobody_is_late():
    assert lateness(DUE, None) == UNKNOWN


@given(st.datetimes(timezones=st.just(UTC)))
def test_late_is_after_the_deadline_and_nothing_else(time):
    assert bool(lateness(DUE, time)) == (time - DUE > timedelta(0))
