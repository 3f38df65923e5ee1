"""Predictions and questions of review: read from a lesson, answered, kept, set beside their outcome."""

import json

import pytest

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.lessons import notebook
from gz_course.grader.lessons.kept import NAME, PREDICTIONS, STEPS, Kept
from gz_course.grader.lessons.lesson import Question, load_lesson
from gz_course.grader.lessons.notebook import Classroom
from gz_course.grader.lessons.questions import Ask, beside

LESSON = """
[predict.stands]
objective = 1
choices = ["ahead", "where it was"]
answer = 2
why = "Nobody listens there."

[predict.machine]
objective = 1
why = "It depends on the machine."

[[review]]
objective = 1
question = "Which field turns?"
choices = ["linear.x", "angular.z"]
answer = 2
why = "The upward axis is z."
"""


@pytest.fixture
def chapter(tmp_path):
    """The folder of a chapter whose exercise has a lesson."""
    grading = tmp_path / "exercises/90_try/grading"
    grading.mkdir(parents=True)
    (grading / "exercise.toml").write_text("")
    (grading / "lesson.toml").write_text(LESSON)
    folder = tmp_path / "chapters/90_try"
    folder.mkdir(parents=True)
    return folder


@pytest.fixture
def classroom(chapter):
    return Classroom(None, chapter)


def test_a_prediction_is_kept_and_set_beside_the_next_cell(classroom, chapter, capsys):
    classroom.predict("stands", 1)
    classroom.after_cell()  # of the cell that asks
    assert capsys.readouterr().out == ""
    classroom.after_cell()
    assert capsys.readouterr().out == "\nYou predicted: ahead. It is: where it was. Nobody listens there.\n"
    classroom.after_cell()
    assert capsys.readouterr().out == ""
    assert json.loads((chapter / NAME).read_text())[PREDICTIONS] == {"stands": "ahead"}


def test_a_kept_prediction_is_there_in_another_kernel(classroom, chapter):
    classroom.predict("machine", "about three")
    assert "Your answer: about three" in repr(Classroom(None, chapter).predict("machine"))


def test_words_do_where_there_are_no_widgets(classroom, monkeypatch, capsys):
    monkeypatch.setitem(__import__("sys").modules, "ipywidgets", None)
    classroom.predict("stands")._ipython_display_()
    said = capsys.readouterr().out
    assert said == '  1  ahead\n  2  where it was\nTo answer, write room.predict("stands", 1)\n'


def test_a_click_is_kept(classroom, chapter):
    ask = classroom.predict("stands")
    box = ask._widget().children[0]
    box.value = "where it was"
    assert Kept(chapter).prediction("stands") == "where it was"


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("b", "As you predicted: b. So."),
        ("a", "You predicted: a. It is: b. So."),
        (None, "You made no prediction. It is: b. So."),
    ],
)
def test_what_stands_beside_the_outcome(said, words):
    assert beside(Question("q", 1, ("a", "b"), 2, "So."), said) == words


def test_without_an_answer_only_the_reason_is_said():
    assert beside(Question("q", 1, (), 0, "So."), "maybe") == "You predicted: maybe. So."


@pytest.mark.parametrize("choice", [0, 3, True, 1.0, None])
def test_a_number_that_is_none_is_refused(chapter, choice):
    question = load_lesson(chapter.parents[1] / "exercises/90_try").prediction("stands")
    with pytest.raises(UsageError, match="give a number from 1 to 2"):
        question.said(choice)


def test_an_unknown_prediction_names_the_nearest(classroom):
    with pytest.raises(UsageError, match="did you mean 'stands'"):
        classroom.predict("stand")


def test_a_question_of_review_is_answered(classroom, capsys):
    assert next(repr(each) for each in classroom.review("90_try")).startswith("Which field turns?")
    classroom.review("90_try", 1, 1)
    assert capsys.readouterr().out == "No, it is: angular.z. The upward axis is z.\n"


def test_a_chapter_without_questions_says_so_and_the_notebook_goes_on(classroom, capsys):
    assert classroom.review("91_none") is None
    assert capsys.readouterr().out == "There are no questions about 91_none.\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[predict.a]\nobjective = 1\nchoices = ['x']\nanswer = 2\nwhy = ''", "answer is 2, but there are 1 choices"),
        ("[predict.a]\nwhy = ''", "objective"),
        ("[predict.a]\nobjective = 1\nwhy = ''\ncorrect = 1", "'correct'"),
        ("predict = 1", "lesson.toml"),
        ("[predict", "lesson.toml"),
    ],
)
def test_a_lesson_that_cannot_be_read_is_one_sentence(chapter, text, says):
    folder = chapter.parents[1] / "exercises/90_try"
    (folder / "grading/lesson.toml").write_text(text)
    with pytest.raises(ManifestError, match=says):
        load_lesson(folder)


@pytest.mark.parametrize("text", ["", "[]", '{"steps": 3}', "\xff", '{"steps": {"a": 1}}'])
def test_a_file_that_cannot_be_read_counts_as_empty(chapter, text):
    (chapter / NAME).write_bytes(text.encode("latin-1"))
    kept = Kept(chapter)
    assert kept.steps() == set()
    kept.keep(STEPS, "circle", True)
    assert Kept(chapter).steps() == {"circle"}


def test_a_plain_program_is_no_notebook(classroom):
    assert notebook._shell() is None
    classroom.begin()


def test_an_ask_repeats_its_question():
    ask = Ask(Question("q", 1, ("a",), 1, "", "What?"), "ask({})", None, str)
    assert repr(ask) == "What?\n  1  a\nTo answer, write ask(1)"
