"""What lateness costs, and extensions."""

from datetime import UTC, datetime, timedelta

import pytest

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.whole_class.final import Final
from gz_course.grader.whole_class.late_policy import CLASS, LatePolicy, read_policy

DUE = datetime(2026, 11, 20, 23, 59, tzinfo=UTC)


@pytest.mark.parametrize(
    ("late", "off"),
    [(-1.0, 0), (0.0, 0), (1 / 24, 10), (24.0, 10), (24.1, 20), (72.0, 30), (72.1, 100)],
)
def test_a_tenth_a_day_and_nothing_after_three(late, off):
    policy = LatePolicy(DUE, 0.1, 3)
    assert policy.taken_off(DUE + timedelta(hours=late), 100)[0] == pytest.approx(off)
    extended = DUE + timedelta(days=7)
    assert policy.taken_off(DUE + timedelta(hours=late), 100, extended) == (0.0, "")
    assert policy.taken_off(None, 100) == (0.0, "")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('deadline = "soon"', "class.toml: deadline 'soon' is no time"),
        ('deadline = "2026-11-20 23:59"', "has no time zone"),
        ('deadline = "2026-11-20 23:59 UTC"\nlate = "a lot"', "late is 'a lot'; write it as"),
        ('deadline = "2026-11-20 23:59 UTC"\nlatte = "x"', "latte"),
        ("", "deadline"),
    ],
)
def test_what_is_wrong_in_the_file(tmp_path, text, words):
    (tmp_path / CLASS).write_text(text)
    with pytest.raises((UsageError, ManifestError)) as told:
        read_policy(tmp_path)
    assert words in str(told.value)


def test_a_class_with_an_extension(exercise, tmp_path):
    (tmp_path / CLASS).write_text('deadline = "2026-11-20 23:59 UTC"\nlate = "10 % a day, 3 days"\n')
    (tmp_path / "overrides.csv").write_text("student,deadline\ncy,2026-11-27 23:59 UTC\n")
    names = {
        "ada": DUE - timedelta(hours=1),
        "bo": DUE + timedelta(hours=30),
        "cy": DUE + timedelta(days=5),
        "di": None,
    }
    points = {each.id: each.points for each in exercise.checks}
    results = [
        {"student": name, "id": "", "points": points, "score": 100.0, "outcome": "graded"}
        | ({"submitted": time.isoformat()} if time else {})
        for name, time in names.items()
    ]
    found = Final(exercise, tmp_path, [(name, "") for name in names]).results(results)
    assert {each["student"]: each["score"] for each in found} == {"ada": 100, "bo": 80, "cy": 100, "di": 100}
    assert found[1]["changes"] == ["100 -> 80 (2 days late)"]
