"""Who has which place in a class, and where the page shows it."""

import dataclasses

from gz_course.grader.exercise.leaderboard import HIGHEST, LOWEST, Ranked
from gz_course.grader.whole_class.index import as_page
from gz_course.grader.whole_class.leaderboard import MOST, boards

NAME = "Time <s>"


def result(student, value=None):
    ranked = [] if value is None else [{"name": NAME, "value": value, "best": LOWEST}]
    return {
        **{"student": student, "id": "", "submission": "x", "score": 1, "points": {}, "outcome": "graded"},
        **{"diagnosis": "", "folder": student, "sha256": "", "truth_sha256": "", "leaderboard": ranked},
    }


CLASS = [result("Bo", 3.5), result("Al", 3.5), result("Cy"), result("Di", 2.0), result("<Ed>", 9.0)]


def test_equal_numbers_share_a_place(exercise):
    ranked = dataclasses.replace(exercise, leaderboard=(Ranked(NAME, "x", LOWEST),))
    (board,) = boards(ranked, CLASS)
    assert board.places == ((1, "Di", 2.0), (2, "Al", 3.5), (2, "Bo", 3.5), (4, "<Ed>", 9.0))
    other = dataclasses.replace(exercise, leaderboard=(Ranked(NAME, "x", HIGHEST),))
    assert [student for _, student, _ in boards(other, CLASS)[0].places] == ["<Ed>", "Al", "Bo", "Di"]
    assert boards(ranked, [result("Cy")]) == boards(exercise, CLASS) == []
    assert len(boards(ranked, [result(f"{n}", n) for n in range(99)])[0].places) == MOST


def test_the_page_shows_it_as_text(exercise):
    ranked = dataclasses.replace(exercise, leaderboard=(Ranked(NAME, "x", LOWEST),))
    page = as_page(ranked, CLASS, [])
    assert "Leaderboard: Time &lt;s&gt;" in page and "&lt;Ed&gt;" in page
    assert page.index("Di</th>") < page.index("Al</th>") < page.index("Bo</th>")
    assert "Leaderboard" not in as_page(exercise, CLASS, [])
