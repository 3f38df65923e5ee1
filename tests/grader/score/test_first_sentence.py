"""The first sentence: short, whole, and nothing of what was said is lost."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.score.first_sentence import MOST_WORDS, first_of, split_first, words

LONG = "one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen"


@pytest.mark.parametrize(
    ("text", "first", "rest"),
    [
        ("", "", ""),
        ("It fell.", "It fell.", ""),
        ("It fell. It was too tall.", "It fell.", "It was too tall."),
        ("node.py, line 3: a was 0.5 m. Look there.", "node.py, line 3: a was 0.5 m.", "Look there."),
        ("Use e.g. Node. Then run it.", "Use e.g. Node.", "Then run it."),
        ("Is it spun? /odom says no.", "Is it spun?", "/odom says no."),
        (f"{LONG}; {LONG}.", f"{LONG}.", f"{LONG.capitalize()}."),
        (f"{LONG} ({LONG}). More.", f"{LONG}.", f"{LONG.capitalize()}. More."),
        (f"It turns: {LONG}; {LONG}.", f"It turns: {LONG}.", f"{LONG.capitalize()}."),
        (f"{LONG}; gz topic -l lists {LONG}.", f"{LONG}.", f"gz topic -l lists {LONG}."),
        (f"{LONG} (a.py, line 22: f(x) {LONG}(y)).", f"{LONG} (a.py, line 22).", f"f(x) {LONG}(y)."),
        (f"It is {LONG}, or {LONG}, not one.", f"It is {LONG}.", f"Or {LONG}, not one."),
        (f"It is {LONG}, or one; {LONG}.", f"It is {LONG}, or one.", f"{LONG.capitalize()}."),
        (f"{LONG}: self.get_clock() {LONG}.", f"{LONG}.", f"self.get_clock() {LONG}."),
    ],
)
def test_where_a_text_is_cut(text, first, rest):
    assert split_first(text) == (first, rest)


@pytest.mark.parametrize(
    ("text", "first", "rest"),
    [
        ("It stops: it did not.", "It stops: it did not.", ""),
        (
            f"It keeps the distance: the robot was as far from the wall as {LONG}: {LONG}. More.",
            f"The robot was as far from the wall as {LONG}.",
            f"{LONG.capitalize()}. More.",
        ),
        (
            f"It comes once only: hello.py, line 13: sent > 1 is, as it stands, {LONG}; {LONG}.",
            f"hello.py, line 13: sent > 1 is, as it stands, {LONG}.",
            f"{LONG.capitalize()}.",
        ),
    ],
)
def test_a_title_alone_says_nothing_of_a_fault(text, first, rest):
    title = text.partition(":")[0]
    found = first_of(text, title)
    assert found == (first, f"{rest} {title}." if rest else "")
    measured = first_of(f"{text} Measured: 3.", title)[1]
    assert measured == (f"{rest} {title}. Measured: 3." if rest else "Measured: 3.")
    assert first_of(text, "") == split_first(text)


def test_a_fault_that_takes_too_many_words_stays_in_the_rest():
    said = f"{LONG} {LONG}"
    assert first_of(f"It stops well: a.py, line 3: {said}.", "It stops well")[0] == "It stops well: a.py, line 3."


def test_the_value_of_a_key_is_not_parted_from_it():
    first, rest = split_first(f"It stops: {LONG}; [ or direction: GZ_TO_ROS is enough, {LONG}.")
    assert first == f"It stops: {LONG}." and rest.startswith("[ or direction: GZ_TO_ROS is")


def test_no_cut_parts_a_line_from_what_is_there():
    first, rest = split_first(f"So it said all the while: {LONG}, robot.sdf:15: {LONG}.")
    assert first == "So it said all the while."
    assert "robot.sdf:15: one" in rest


def test_what_has_no_place_to_be_cut_stays_whole():
    text = f"{LONG} {LONG}."
    assert split_first(text) == (text, "")


@given(st.lists(st.from_regex(r"[A-Za-z]{1,8}( [a-z]{1,8}){0,12}[.;:,]", fullmatch=True), min_size=1, max_size=8))
def test_no_word_is_lost_and_a_cut_sentence_is_short(parts):
    text = " ".join(parts)
    first, rest = split_first(text)
    letters = re.compile(r"[a-z]+")
    assert letters.findall(f"{first} {rest}".lower()) == letters.findall(text.lower())
    assert words(first) <= MOST_WORDS or not re.search(r"[;:] ", " ".join(first.split()[4:MOST_WORDS]))
