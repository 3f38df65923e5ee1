"""The gradebook: safe to open in a spreadsheet whatever students are called, and nothing in it but what they earned."""

import csv
import io

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.whole_class.gradebook import GRADEBOOK, as_csv, cell, write_gradebook


def result(**more):
    return {
        "student": "Jane", "id": "7", "submission": "jane.py", "score": 65.0, "outcome": "graded",
        "points": {"stops": 20}, "diagnosis": "", "sha256": "ab", "truth_sha256": "cd", "folder": "Jane",
    } | more  # fmt: skip


def rows(text):
    return list(csv.DictReader(io.StringIO(text, newline="")))


def test_a_line_a_student_with_points_for_each_check(exercise):
    (row,) = rows(as_csv(exercise, [result()]))
    assert list(row)[:6] == ["student", "id", "submission", "score", "max_score", "outcome"]
    assert (row["student"], row["score"], row["max_score"], row["stops"]) == ("Jane", "65", "100", "20")
    assert [check.id for check in exercise.checks] == list(row)[6:-8]


def test_who_could_not_be_graded_has_no_points_rather_than_none(exercise):
    (row,) = rows(as_csv(exercise, [result(score=None, points={}, outcome="infra", diagnosis="not graded: x")]))
    assert (row["score"], row["stops"], row["outcome"]) == ("", "", "infra")


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r", "\n", "＝", "  =", "\x00="])
def test_no_cell_is_a_formula(start):
    assert cell(f"{start}cmd|' /C calc'!A0").startswith("'") or cell(f"{start}cmd")[0] == "\N{REPLACEMENT CHARACTER}"


@pytest.mark.parametrize(("value", "text"), [(65.0, "65"), (0, "0"), (0.1 + 0.2, "0.3"), (None, ""), ("a-b", "a-b")])
def test_plain_cells(value, text):
    assert cell(value) == text


@given(st.lists(st.text(max_size=40), min_size=1, max_size=4), st.text(max_size=80))
def test_any_text_comes_back_as_one_cell_of_one_row(exercise, names, told):
    text = as_csv(exercise, [result(student=name, diagnosis=told, folder=name) for name in names])
    found = rows(text)
    assert len(found) == len(names)
    for row in found:
        assert None not in row and None not in row.values()
        for value in row.values():
            assert value.isprintable() and not value.lstrip().startswith(("=", "+", "-", "@"))


def test_the_gradebook_is_replaced_in_one_go(tmp_path):
    write_gradebook(tmp_path, "a\n")
    with (tmp_path / GRADEBOOK).open(encoding="utf-8-sig") as before:
        write_gradebook(tmp_path, "b\n")
        assert before.read() == "a\n", "who has it open reads the old one to its end"
    assert [path.name for path in tmp_path.iterdir()] == [GRADEBOOK]
