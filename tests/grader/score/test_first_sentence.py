"""The first sentence: short, whole, and nothing of what was said is lost."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.score.first_sentence import MOST_WORDS, split_first, words

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
        (f"{LONG}: self.get_clock() {LONG}.", f"{LONG}.", f"self.get_clock() {LONG}."),
    ],
)
def test_where_a_text_is_cut(text, first, rest):
    assert split_first(text) == (first, rest)


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
