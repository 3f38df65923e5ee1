"""Whose grade is whose: by ids of the platform, logins, addresses and names, however they are written."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.learning_platforms.matching import fold, match
from gz_course.grader.learning_platforms.roster import read_roster
from gz_course.grader.whole_class.platforms import CANVAS, GRADESCOPE, MOODLE
from gz_course.tests.grader.learning_platforms.classes import (
    CANVAS_HEAD,
    MOODLE_HEAD,
    WORKSHEET_HEAD,
    row,
    table,
)


@pytest.fixture
def roster(tmp_path):
    def write(*rows, **more):
        path = tmp_path / "roster.csv"
        path.write_text(table(*rows, **more), encoding="utf-8", newline="")
        return read_roster(path)

    return write


def who(row, roster):
    (found,) = match([row], roster)
    return found.person.names[0] if found.person else found.why


JANE = ["Jane", "Doe", "s123", "jane.doe@example.org", ""]
JOHN = ["John", "Roe", "s124", "j.roe@example.org", ""]


@pytest.mark.parametrize(
    ("student", "id"),
    [
        ("Jane Doe", ""), ("doe, jane", ""), ("JANE  DOE", ""), ("Jane\N{NO-BREAK SPACE}Doe", ""), ("Ｊane Doe", ""),
        ("s123", ""), ("jane.doe", ""), ("Jane.Doe@Example.org", ""), ("somebody", "s123"), ("janedoe", ""),
        ("x", "JANE.DOE@example.org"), ("jane_doe", ""), ("Jane Doe [2]", ""),
    ],
)  # fmt: skip
def test_a_student_is_found(roster, student, id):
    assert who(row(student, id), roster(MOODLE_HEAD, JANE, JOHN)) == "Jane Doe"


def test_nobody_and_several(roster):
    people = roster(MOODLE_HEAD, JANE, ["Jane", "Doe", "s125", "jd@example.org", ""])
    assert "nobody" in who(row("Linus"), people)
    assert who(row("Jane Doe"), people) == "its name fits several people of the roster, on the lines 2, 3"
    assert who(row("jd"), people) == "Jane Doe"


def test_two_submissions_of_one_person_are_left_to_a_person(roster):
    found = match([row("Jane Doe [1]", submission="a"), row("s123", submission="b")], roster(MOODLE_HEAD, JANE))
    assert [each.person for each in found] == [None, None]
    assert {each.why for each in found} == {"Jane Doe has several submissions: a, b"}


def test_a_participant_of_moodle_is_found_by_number_if_the_name_agrees(roster):
    blank = [""] * 7
    people = roster(WORKSHEET_HEAD, ["Participant 17", "Jane Doe", "a@b", *blank], ["Participant 18", "X", "", *blank])
    assert who(row("Jane Doe", "17", "Jane Doe_17_assignsubmission_file_", platform=MOODLE), people) == "Jane Doe"
    other = who(row("Jane Doe", "18", "Jane Doe_18_assignsubmission_file_", platform=MOODLE), people)
    assert other == "participant 18 of the roster is X; is the worksheet of another assignment?"


def test_a_number_of_moodle_is_no_id_number(roster):
    people = roster(MOODLE_HEAD, ["Jane", "Doe", "18", "a@b.c", ""], ["John", "Roe", "17", "d@e.f", ""])
    assert who(row("Jane Doe", "17", "Jane Doe_17_assignsubmission_file_", platform=MOODLE), people) == "Jane Doe"


def test_the_name_of_a_file_says_nothing_about_its_platform(roster):
    people = roster(
        CANVAS_HEAD, ["Doe, Jane", "4711", "s1", "jane", "A", "", ""], ["Roe, J", "1", "", "x", "A", "", ""]
    )
    for name in ("x_4711_99120_t.py", "x_4711_assignsubmission_file_t.py"):
        assert who(row("x", "", name), people) == "J Roe", "the login"
        assert "Canvas ID" in who(row("x", "9", name, platform=CANVAS), people)


def test_who_has_an_id_is_not_found_by_a_name_that_is_the_id_of_another(roster):
    people = roster(MOODLE_HEAD, JANE, JOHN)
    for name in ("s123", "jane.doe@example.org"):
        assert "nobody" in who(row(name, "s999", "submission_1", platform=GRADESCOPE), people)
        assert who(row(name, "s124", "submission_1", platform=GRADESCOPE), people) == "John Roe"


def test_canvas_is_matched_by_its_own_number_only(roster):
    people = roster(CANVAS_HEAD, ["Doe, Jane", "4711", "s1", "jane", "A", "", ""], ["Roe, J", "1", "", "", "A", "", ""])
    assert who(row("doejane", "4711", "doejane_LATE_4711_99120_t.py", platform=CANVAS), people) == "Jane Doe"
    nobody = who(row("doejane", "9", "doejane_9_99120_t.py", platform=CANVAS), people)
    assert "nobody in the roster has the Canvas ID" in nobody
    assert who(row("doejane"), people) == "Jane Doe"


def test_a_group_has_a_grade_for_each_member(roster):
    found = match([row("Jane Doe & John Roe & A B", "s123;j.roe@example.org;")], roster(MOODLE_HEAD, JANE, JOHN))
    assert [each.person and each.person.names[0] for each in found] == ["Jane Doe", "John Roe", None]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_any_encoding_and_delimiter_of_an_export(tmp_path, encoding, delimiter):
    path = tmp_path / "r.csv"
    person = ["Jörg", "Müller", "1", "j@x.de", ""]
    path.write_bytes(table(MOODLE_HEAD, person, delimiter=delimiter).encode(encoding))
    assert who(row("jörg müller"), read_roster(path)) == "Jörg Müller"


def test_addresses_are_recognised_in_any_language(roster):
    people = roster(["Vorname", "Nachname", "E-Mail-Adresse"], ["Jane", "Doe", "jd@x.de"])
    assert match([row("jd")], people)[0].person is not None


letters = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\r\n\x00"), min_size=1, max_size=12)


@given(st.lists(letters, min_size=1, max_size=6), st.sampled_from(["NFC", "NFD", "NFKC", "NFKD"]))
def test_a_name_is_itself_in_every_composition(names, form):
    for name in names:
        assert fold(unicodedata.normalize(form, name)) == fold(name)
        assert fold(fold(name)) == fold(name)
