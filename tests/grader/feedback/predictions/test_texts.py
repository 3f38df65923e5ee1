"""Texts that are nearly right, messages at a wrong moment, and files looked for in the wrong folder."""

import numpy as np
import pytest

from gz_course.grader.feedback.predictions.texts import difference, line_difference, too_many, wrong_moment
from gz_course.grader.score.launched import looked_elsewhere

WANTED = "hello, robot"


@pytest.mark.parametrize(
    ("said", "words"),
    [
        (WANTED, ""),
        ("", "the text is empty"),
        ("something else", ""),
        ("Hello, robot", "capitals and small letters only"),
        ("hello robot", "punctuation marks only"),
        ("hello,robot", "spaces only"),
        ("'hello, robot'", "quotation marks only, as json.dumps() and repr() put them"),
        ("hello, robot\n", "white space before or after"),
        ("Hello robot!", "capitals and small letters and punctuation marks"),
        ("hello, robto", "letter by letter"),
        ("std_msgs.msg.String(data='hello, robot')", "that of a whole message"),
        ("I say hello, robot and then some more", "more than is asked for"),
    ],
)
def test_the_difference_is_named(said, words):
    assert words in difference(said, WANTED) and bool(words) == bool(difference(said, WANTED))


@pytest.mark.parametrize(
    ("first", "words"), [(1.0, ""), (2.0, "twice"), (0.1, "a tenth"), (0.2, "too soon"), (2.6, "too late")]
)
def test_the_moment_is_named(first, words):
    said = wrong_moment(np.array([first]), (0.9, 1.6))
    assert words in said and bool(words) == bool(said)


def test_a_relative_path_is_named():
    bridge = "bridge.yaml: cannot read the bridge configuration: No such file or directory"
    python = "/usr/bin/python3: can't open file '/tmp/stopwatch.py': [Errno 2] No such file or directory"
    assert "bridge.yaml was looked for in the folder in which ros2 launch was called" in looked_elsewhere(bridge)
    assert "Path(__file__).parent / 'stopwatch.py'" in looked_elsewhere(python)
    assert looked_elsewhere("bridge.yaml:3: not valid YAML") == looked_elsewhere("") == ""


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([1.0], ""),
        ([1.0, 1.0], "2 times at the same moment"),
        ([1.0, 2.0, 3.0], "every 1.00 s until the end"),
        ([0.5, 1.0], "0.50 s apart and ceased"),
        ([0.5, 1.0, 3.0], ""),
    ],
)
def test_the_way_of_too_many_messages_is_named(times, words):
    said = too_many(np.array(times), 3.0)
    assert words in said and bool(words) == bool(said)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (
            ["Scan: 301 valid rays, min: 1.57m, avg: 2.86m"],
            "after 'rays, min' the line has ': N.NNm', where '=N.NNm,'",
        ),
        (
            ["Scan: 301.0 valid rays, min=1.57m, avg=2.86m"],
            "after 'Scan:' the line has 'N.NN valid', where 'N valid'",
        ),
        (["301 valid rays, min=1.57m, avg=2.86m"], "at its beginning the line has 'N valid"),
        (["Scan: 301 valid rays, min=inf, avg=2.86m"], "after 'min=N.NN' the line has ', avg=', where 'm, avg'"),
        (["Scan: 301 valid rays, min=1.57m, avg=2.86"], "the line ends, where 'm' is asked for"),
        (["Scan: 301 valid rays, min=1.57m, avg=2.86m!"], "has '!', where it should end"),
        (["Scan: 301 valid rays", "min=1.57m", "avg=2.86m"], "spread over several"),
        (["Scan: 1 valid rays, min=0.57m, avg=12.86m"], ""),
        ([], ""),
    ],
)
def test_in_what_a_line_of_the_log_differs(lines, words):
    said = line_difference(lines, "Scan: 301 valid rays, min=1.23m, avg=4.56m")
    assert words in said and bool(words) == bool(said)
