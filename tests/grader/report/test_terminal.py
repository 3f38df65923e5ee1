"""The report in a terminal: complete at every width, a word for every colour, and foreign text is nothing but text."""

import dataclasses
import io
import re
from pathlib import Path

import pytest
from hypothesis import given

from gz_course.grader.report.report import TrialReport
from gz_course.grader.report.terminal import disarmed, print_report
from gz_course.tests.grader.report.handmade import NASTY, REPORT, nasty, result, score_of


def printed(report, width=100):
    out = io.StringIO()
    print_report(report, out, width)
    return out.getvalue()


def flat(text):
    return " ".join(text.split())


def with_texts(*, measured="was 0.5", diagnosis="", **more):
    score = score_of(result("good", True, measured), result("bad", False, measured), diagnosis=diagnosis)
    return dataclasses.replace(REPORT, score=score, **more)


def test_without_colour_every_state_is_a_word():
    text = printed(REPORT)
    assert "\x1b" not in text
    lines = text.splitlines()
    assert next(line for line in lines if "Title of good" in line) == "pass  Title of good  50/50"
    assert next(line for line in lines if "Title of bad" in line) == "FAIL  Title of bad  0/50"
    assert "score: 50 of 100  (graded)" in text
    assert "The bad one: was 0.5." in text
    assert "runs/03_teleop.rrd" in text and "16.0 x real time" in text


def test_colours_are_for_those_who_want_them(monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    colourful = printed(REPORT)
    assert "\x1b[32mpass" in colourful and "\x1b[1;31mFAIL" in colourful
    monkeypatch.setenv("NO_COLOR", "1")
    assert not re.search(r"\x1b\[[0-9;]*3[0-9]", printed(REPORT))


def test_each_check_says_what_was_expected_and_measured_and_when():
    text = printed(REPORT)
    assert "      was 0.5, at 1.25 s; expected: is 0.5\n" in text
    failed = text[text.index("FAIL") :]
    for line in (
        "expected: is 0.5",
        "measured: was 0.5",
        "when:     1.25 s of simulated time",
        "hint:     Hint for bad.",
    ):
        assert f"      {line}\n" in failed
    assert "Hint for good." not in text


def nothing_earned(**more):
    first, gated = result("good", False), result("bad", False, gated=True)
    return dataclasses.replace(REPORT, score=score_of(first, gated, diagnosis="Begin with the good one."), **more)


def beside_a_page(report, **how):
    out = io.StringIO()
    print_report(report, out, 100, page=Path("runs/03_teleop.html"), **how)
    return out.getvalue()


def with_hints(report, *hints):
    """The report with these hints for each check."""
    checks = [dataclasses.replace(c, spec=dataclasses.replace(c.spec, hints=hints)) for c in report.score.checks]
    return dataclasses.replace(report, score=dataclasses.replace(report.score, checks=tuple(checks)))


def test_a_further_hint_is_offered_if_there_is_one():
    further = "course hint 03_teleop shows the next one."
    three = with_hints(REPORT, "Look there.", "The idea.", "Another case.")
    assert further not in beside_a_page(REPORT)
    assert further not in beside_a_page(three)  # the instructor shows one
    text = beside_a_page(dataclasses.replace(three, hints_shown=3))
    assert "hint: Look there.\n" in text and further in text
    assert "The idea." not in text


def test_a_starter_gets_no_hint():
    text = beside_a_page(dataclasses.replace(REPORT, untouched=True))
    assert "hint:" not in text


def test_details_are_printed_on_request():
    told = dataclasses.replace(REPORT, score=dataclasses.replace(REPORT.score, details="The rest of it."))
    assert "The rest of it." not in beside_a_page(told)
    text = beside_a_page(told, details=True)
    assert "The rest of it." in text and "measured: was 0.5" in text


def test_the_page_says_the_rest():
    text = beside_a_page(nothing_earned())
    assert "Begin with the good one." in text
    assert text.count("FAIL") == 2
    assert "Hint for good." in text and "Hint for bad." not in text
    assert "expected:" not in text and "measured:" not in text
    assert "page:      runs/03_teleop.html\n" in text


def test_without_a_page_nothing_is_left_out_but_hints_that_do_not_apply():
    text = printed(nothing_earned())
    assert text.count("expected:") == text.count("measured:") == 2
    assert "Hint for good." in text and "Hint for bad." not in text
    assert "page:" not in text


def test_long_texts_go_on_below_their_beginning():
    text = printed(with_texts(measured="a rather long sentence " * 4), width=60)
    lines = text[text.index("measured") :].splitlines()
    assert lines[1].startswith(" " * 16 + "a rather") or lines[1].startswith(" " * 16)
    assert max(map(len, text.splitlines())) <= 60


@pytest.mark.parametrize("width", [24, 40, 80, 200])
def test_nothing_is_lost_at_any_width(width):
    words = set(printed(REPORT, width=300).split())
    narrow = "".join(printed(REPORT, width=width).split())
    assert [word for word in words if word not in narrow] == []


@pytest.mark.parametrize("width", [0, 1, 5])
def test_a_terminal_without_width_is_no_fault(width):
    assert "Title" in printed(REPORT, width=width)


@pytest.mark.parametrize(
    "text", ["[bold]x[/bold]", "[/]", "[red]", "a\\", "a\\\\\\", "[link=file:///x]x[/link]", "\\[x]"]
)
def test_what_a_student_wrote_is_never_markup(text):
    report = with_texts(measured=f"saw {text}", diagnosis=f"It says {text}", submission=f"/home/{text}/node.py")
    assert printed(report).count(text) == 4


@pytest.mark.parametrize("code", ["\x1b[2J", "\x1b]0;title\x07", "\x9b31m", "\r", "\x08", "\0", "\u202e"])
def test_control_codes_of_a_student_never_reach_the_terminal(code):
    told = printed(with_texts(diagnosis=f"died with {code}passed"))
    assert not [c for c in told if not c.isprintable() and c != "\n"], repr(told)
    assert "passed" in told


@pytest.mark.parametrize(
    "command", ["::error::no", "  ::stop-commands::x", "\x1b[1m::warning::", "a ##[group]b", "##vso[x]"]
)
def test_commands_to_a_build_service_are_broken(command):
    changed = disarmed(f"first\n{command}\nlast")
    assert not obeyed(changed)
    assert changed.replace(" ", "") == f"first\n{command}\nlast".replace(" ", "")


def obeyed(text):
    """Lines that GitHub Actions or Azure Pipelines would take for a command."""
    bare = re.sub(r"\x1b\[[0-9;]*m", "", text)
    return [line for line in bare.splitlines() if line.strip().startswith("::") or "##[" in line or "##vso[" in line]


def test_an_ordinary_pair_of_colons_stays():
    assert disarmed("in std::vector: x::y") == "in std::vector: x::y"


@given(nasty)
def test_whatever_a_student_writes_is_printed_as_text(text):
    report = with_texts(measured=text, diagnosis=text, submission=text, notes=(text,), versions={"mujoco": text})
    for width in (30, 100):
        told = printed(report, width)
        assert not obeyed(told)
        assert not [c for c in told if not c.isprintable() and c != "\n"]


def test_a_terminal_that_lacks_characters_gets_others():
    raw = io.BytesIO()
    out = io.TextIOWrapper(raw, encoding="ascii")
    print_report(with_texts(diagnosis="schön, 5 °"), out, 80)
    out.flush()
    assert b"sch?n, 5 ?" in raw.getvalue()


def test_scored_again_it_says_nothing_about_a_host():
    assert "real time" not in printed(dataclasses.replace(REPORT, host=None))


def test_a_note_is_told():
    assert "note: The manifest has changed." in printed(
        dataclasses.replace(REPORT, notes=("The manifest has changed.",))
    )


def test_several_trials_have_a_line_each(tmp_path):
    fine = score_of(result("good", True), result("bad", True))
    trials = (TrialReport("calm", 1, fine, tmp_path / "a.rrd", ""), TrialReport("windy", 7, REPORT.score, tmp_path, ""))
    text = flat(printed(dataclasses.replace(REPORT, trials=trials)))
    assert "trials calm seed 1 100/100 graded windy seed 7 50/100 graded" in text
    assert text.count("recording:") == 2


def test_how_a_node_ended_is_shown(make_report):
    lines = [(1.0, f"line {i}") for i in range(50)] + [(2.0, "ValueError: no"), *((2.0, text) for text in NASTY)]
    score = score_of(result("a", False), result("b", False), outcome="student_error", diagnosis="It died.")
    text = printed(make_report(score, lines=lines[:51]))
    assert "What your node said last:\n  line 39\n" in text and "  ValueError: no\n" in text and "line 38" not in text
    assert not obeyed(printed(make_report(score, lines=lines)))
    assert "said last" not in printed(make_report(lines=lines))


def test_nothing_was_run(not_run):
    text = printed(not_run)
    assert "SyntaxError" in text and "FAIL  Title of good  0/50\nFAIL  Title of bad" in text
    assert "Hint" not in text and "said last" not in text
