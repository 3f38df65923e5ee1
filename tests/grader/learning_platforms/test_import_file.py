"""The files for Moodle and Canvas: every student gets the own score and nobody else's, whatever they are called."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.import_file import import_file
from gz_course.grader.learning_platforms.matching import match
from gz_course.grader.learning_platforms.roster import read_roster
from gz_course.tests.grader.learning_platforms.classes import (
    CANVAS_HEAD,
    MOODLE_HEAD,
    WORKSHEET_HEAD,
    imported_by_canvas,
    imported_by_moodle,
    parsed,
    row,
    table,
)

POINTS = ["    Points Possible", "", "", "", "", "100", "(read only)"]


@pytest.fixture(scope="module")
def roster(tmp_path_factory):
    path = tmp_path_factory.mktemp("roster") / "roster.csv"

    def write(*rows):
        path.write_text(table(*rows), encoding="utf-8", newline="")
        return read_roster(path)

    return write


def made(people, *rows, column="Teleop", points=None, late=None):
    return import_file(people, match(list(rows), people), column, points, late)


def test_canvas(roster):
    people = roster(
        CANVAS_HEAD,
        ["", "", "", "", "", "Manual Posting", ""],
        POINTS,
        ["Doe, Jane", "4711", "s1", "jane", "A", "", "0"],
        ["Roe, John", "4712", "s2", "john", "A", "50", "0"],
    )
    grades = made(people, row("doejane", "4711", "doejane_4711_99_t.py", 65.5), row("nobody"))
    assert imported_by_canvas(grades.text, {4711, 4712}) == ({4711: "65.5"}, "100")
    assert parsed(grades.text)[0][-1] == "Teleop (4711)"
    assert [each.member.name for each, _ in grades.left_out] == ["nobody"]


def test_canvas_points_are_those_of_canvas(roster):
    people = roster(CANVAS_HEAD, [*POINTS[:5], "10", ""], ["Doe, Jane", "4711", "", "", "A", "", ""])
    with pytest.raises(UsageError, match=r"worth 10 points, but the exercise has 100; give --points 10"):
        made(people, row("Jane Doe"))
    assert imported_by_canvas(made(people, row("Jane Doe", score=33.0), points=10).text, {4711}) == (
        {4711: "3.3"},
        "10",
    )


def test_the_assignment_of_canvas(roster):
    head = [*CANVAS_HEAD[:5], "Teleop (1)", "Lidar (2)", "Lidar (3)", "Notes", "Final Score"]
    jane = ["Doe, Jane", "7", "", "", "A", "", "", "", "", ""]
    people = roster(head, ["    Points Possible", "", "", "", "", "100", "100", "100", "", "(read only)"], jane)
    assert parsed(made(people, row("Jane Doe")).text)[0][-1] == "Teleop (1)"
    assert parsed(made(people, row("Jane Doe"), column="Lidar (3)").text)[0][-1] == "Lidar (3)"
    for column, words in (("Lidar", "several"), ("Telop", r"did you mean 'Teleop \(1\)'"), ("zzz", "its columns are")):
        with pytest.raises(UsageError, match=words):
            made(people, row("Jane Doe"), column=column)


def test_late_is_a_column_of_canvas_only_if_canvas_has_it(roster):
    head = [*CANVAS_HEAD[:5], "LATE", "Teleop (1)"]
    people = roster(head, [*POINTS[:5], "", "100"], ["Doe, Jane", "7", "", "", "A", "", ""])
    assert parsed(made(people, row("Jane Doe"), late=lambda _: "LATE by 1 d").text)[2][5:] == ["LATE by 1 d", "80"]
    people = roster(CANVAS_HEAD, POINTS, ["Doe, Jane", "7", "", "", "A", "", ""])
    assert len(parsed(made(people, row("Jane Doe"), late=lambda _: "LATE by 1 d").text)[0]) == 6


def test_a_student_who_is_called_like_the_row_of_points(roster):
    people = roster(CANVAS_HEAD, POINTS, ["Points Possible, My", "7", "", "me", "A", "", ""])
    assert imported_by_canvas(made(people, row("me")).text, {7}) == ({7: "80"}, "100")


def test_the_worksheet_of_moodle_comes_back_with_grades(roster):
    jane = ["Participant 17", "Jane Doe", "j@x.org", "Submitted", "", "100.00", "Yes", "x", "-", ""]
    john = ["Participant 18", "John Roe", "r@x.org", "No", "", "100.00", "Yes", "-", "-", ""]
    people = roster(WORKSHEET_HEAD, jane, john)
    grades = made(
        people,
        row("Jane Doe", "17", "Jane Doe_17_assignsubmission_file_", 65.0, diagnosis="<b> & =x", platform="Moodle"),
        late=lambda _: "",
    )
    head, line = parsed(grades.text)
    assert head == [*WORKSHEET_HEAD, "LATE"]
    assert line == [*jane[:4], "65", *jane[5:9], "&lt;b&gt; &amp; =x", ""]
    with pytest.raises(UsageError, match="give --points 100 to scale"):
        made(people, row("Jane Doe", max_score=60.0))


def test_moodle(roster):
    people = roster(
        MOODLE_HEAD, ["Jane", "Doe", "", "j@x.org", "1"], ["John", "Roe", "5", "", ""], ["=A", "B", "6", "=1@x.org", ""]
    )
    rows = [row("Jane Doe", diagnosis="-1 is <wrong>"), row("John Roe"), row("6", score=None, outcome="infra")]
    grades = made(people, *rows, late=lambda _: "unknown")
    assert parsed(grades.text)[0] == [*MOODLE_HEAD[:4], "Teleop", "Teleop (Feedback)", "LATE"]
    assert imported_by_moodle(grades.text, "ID number", {"5", "6"}, "Teleop") == {"5": ("80", "")}
    assert "Map from ID number" in grades.advice
    assert [why.partition(":")[0] for _, why in grades.left_out] == [
        "on line 2 of the roster ID number is empty, not unique, or a formula",
        "not graded",
    ]


def test_who_was_not_graded_has_no_grade(roster):
    people = roster(MOODLE_HEAD, ["Jane", "Doe", "1", "j@x.org", ""])
    grades = made(people, row("Jane Doe", score=None, diagnosis="not graded: a worker died"))
    assert grades.written == () and "a worker died" in grades.left_out[0][1]


def test_an_export_without_people_or_identifiers(roster, tmp_path):
    for rows, words in (((["a", "b"], ["1", "2"]), "none that identifies"), ((MOODLE_HEAD,), "no students")):
        with pytest.raises(UsageError, match=words):
            roster(*rows)
    with pytest.raises(UsageError, match="cannot be read"):
        read_roster(tmp_path / "no.csv")
    (tmp_path / "empty.csv").write_bytes(b"\n\n")
    with pytest.raises(UsageError, match="is empty"):
        read_roster(tmp_path / "empty.csv")


texts = st.text(max_size=20)
nasty = texts | st.sampled_from(
    ["=1+1", "+1", "-2", "@x", "\tx", "＝1", "  =1", "Points Possible", "‮abc", "a\x00b", ""]
)
scores = st.floats(0, 100) | st.none()
people_of = st.lists(st.tuples(nasty, nasty, nasty, nasty, scores, st.booleans()), min_size=1, max_size=6)
SETTINGS = settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])


def given_rows(found):
    """Return rows of a gradebook by their order, whose submissions are numbered."""
    return [
        row(name or "x", id, f"{n}", score, diagnosis=told)
        for n, (name, _, id, told, score, there) in enumerate(found)
        if there
    ]


def no_formulas(text):
    for cells in parsed(text)[1:]:
        for each in cells:
            assert each == "-" or not each.lstrip().startswith(("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠"))


@SETTINGS
@given(people_of)
def test_canvas_gives_every_student_the_own_score(roster, found):
    lines = [[name, str(100 + n), id, login, "A", "", ""] for n, (name, login, id, *_) in enumerate(found)]
    people = roster(CANVAS_HEAD, POINTS, ["Anchor", "1", "", "", "A", "", ""], *lines)
    matches = match([row("anchor", "1"), *given_rows(found)], people)
    grades = import_file(people, matches, "Teleop", None, None)
    got, _ = imported_by_canvas(grades.text, {1, *(100 + n for n in range(len(found)))})
    no_formulas(grades.text)
    assert len(grades.written) + len(grades.left_out) == len(matches), "nobody is lost"
    wanted = {int(each.person.ids["Canvas ID"]): each.member.row.score for each in grades.written}
    assert {id: float(text) for id, text in got.items()} == pytest.approx(wanted, abs=1e-4)


@SETTINGS
@given(people_of)
def test_moodle_gives_every_student_the_own_score(roster, found):
    lines = [[first, last, id, f"{n}@x.org", ""] for n, (first, last, id, *_) in enumerate(found)]
    people = roster(MOODLE_HEAD, *lines)
    matches = match([row("0@x.org"), *given_rows(found)], people)
    grades = import_file(people, matches, "Teleop", None, lambda _: "unknown")
    no_formulas(grades.text)
    if not grades.written:
        return
    by = 2 if "Map from ID number" in grades.advice else 3
    everybody = [person.cells[by] for person in people.people]
    got = imported_by_moodle(grades.text, MOODLE_HEAD[by], set(everybody), "Teleop")
    assert len(grades.written) + len(grades.left_out) == len(matches), "nobody is lost"
    wanted = {each.person.cells[by]: each.member.row.score for each in grades.written}
    assert {id: float(text) for id, (text, _) in got.items()} == pytest.approx(wanted, abs=1e-4)
    assert all(everybody.count(id) == 1 for id in got)
