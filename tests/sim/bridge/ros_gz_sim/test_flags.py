"""Options of ros_gz_sim's executables: dashes, values, rejected input."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_sim.flags import Flag, read
from gz_course.sim.ros.ros_program.errors import UsageError

FLAGS = (
    Flag("name", ""),
    Flag("x", "", "number"),
    Flag("Y", "", "number"),
    Flag("id", "", "whole"),
    Flag("allow_renaming", "", "switch"),
    Flag("pos", "", "number", 3),
)


@pytest.mark.parametrize(
    ("words", "values"),
    [
        (["-name", "box"], {"name": "box"}),
        (["--name=box=1"], {"name": "box=1"}),
        (["-name", "-odd"], {"name": "-odd"}),
        (["-name="], {"name": ""}),
        (["-x", "-1e-3", "-x=2"], {"x": 2.0}),
        (["-allow_renaming", "-x", "1"], {"allow_renaming": True, "x": 1.0}),
        (["-allow_renaming", "false"], {"allow_renaming": False}),
        (["--noallow_renaming"], {"allow_renaming": False}),
        (["-allow_renaming=true", "--id", "7"], {"allow_renaming": True, "id": 7}),
        (["--pos", "1", "-2", "3e0", "-Y", "4"], {"pos": [1.0, -2.0, 3.0], "Y": 4.0}),
        ([], {}),
    ],
)
def test_values(words, values):
    assert read(words, FLAGS) == values


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["-nam", "box"], "there is no option '-nam'; did you mean '-name'?"),
        (["--nam=box"], "there is no option '--nam'; did you mean '--name'?"),
        (["box"], "unexpected argument 'box'; options start with - (see --help)"),
        (["-"], "unexpected argument '-'; options start with - (see --help)"),
        (["-x"], "-x needs a value after it"),
        (["--pos", "1", "2"], "-pos needs 3 values after it"),
        (["-x", "nan"], "-x must be a finite number, got 'nan'"),
        (["-x", "-inf"], "-x must be a finite number, got '-inf'"),
        (["-x", "one"], "-x must be a finite number, got 'one'"),
        (["-id", "-1"], "-id must be a whole number of 0 or more, got '-1'"),
        (["-allow_renaming=maybe"], "-allow_renaming must be true or false, got 'maybe'"),
        (["-noname"], "there is no option '-noname'; did you mean '-name'?"),
    ],
)
def test_what_makes_no_sense(words, sentence):
    with pytest.raises(UsageError) as caught:
        read(words, FLAGS)
    assert str(caught.value) == sentence


@given(st.lists(st.text(max_size=12) | st.sampled_from([f"-{flag.name}" for flag in FLAGS])))
def test_any_words_are_read_or_refused(words):
    try:
        values = read(words, FLAGS)
    except UsageError as error:
        assert str(error)
    else:
        assert all(math.isfinite(values[name]) for name in ("x", "Y") if name in values)


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(["-x {}", "--x={}"]))
def test_numbers_arrive_as_written(number, form):
    assert read(form.format(number).split(), FLAGS) == {"x": number}
