"""The destinations of the output of processes, line by line."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import gz_course.sim.ros.launch.logging as launch_logging
import gz_course.sim.ros.launch.process_output as launch_process_output
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.process_output import ProcessOutput, sinks


class Screen:
    """A substitute for screen and log file, for tests of splitting lines."""

    def __init__(self):
        self.text = ""

    def write_to_screen(self, text):
        assert text.endswith("\n")
        self.text += text


@given(
    st.lists(st.text(st.characters(blacklist_characters="\r\n", blacklist_categories=["Cs"])), max_size=8),
    st.sampled_from(["\n", "\r\n"]),
    st.booleans(),
    st.data(),
)
def test_lines_come_out_whole_however_they_come_in(lines, newline, ended, data):
    raw = newline.join(lines).encode() + (newline.encode() if ended else b"")
    cuts = sorted(data.draw(st.lists(st.integers(0, len(raw)), max_size=6)))
    with pytest.MonkeyPatch.context() as patch:
        screen = Screen()
        patch.setattr(launch_process_output, "launch_config", screen)
        output = ProcessOutput("robot-1", "screen", cached=True, line_format=None)
        for start, end in zip([0, *cuts], [*cuts, len(raw)], strict=True):
            output.feed("stdout", raw[start:end])
        output.flush()
    expected = lines if raw and not (ended and not lines) else []
    if not ended and lines and lines[-1] == "":
        expected = lines[:-1]
    if raw == newline.encode() and ended:
        expected = [""]
    assert screen.text == "".join(f"[robot-1] {line}\n" for line in expected)
    assert output.cached("stdout") == raw


SCREEN, LOG, OWN = "screen", "log", "own_log"


@pytest.mark.parametrize(
    ("word", "stdout", "stderr"),
    [("screen", {SCREEN}, {SCREEN}), ("log", {LOG}, {LOG, SCREEN}), ("both", {SCREEN, LOG}, {SCREEN, LOG})],
)
def test_words(word, stdout, stderr):
    assert sinks(word) == {"stdout": stdout, "stderr": stderr}


def test_a_dict_chooses_for_each_stream():
    assert sinks({"stdout": "screen", "stderr": {"log", "own_log"}}) == {"stdout": {SCREEN}, "stderr": {LOG, OWN}}
    assert sinks({"both": ["screen"]}) == {"stdout": {SCREEN}, "stderr": {SCREEN}}
    assert sinks({}) == {"stdout": set(), "stderr": set()}


def test_the_environment_overrides_it(monkeypatch):
    monkeypatch.setenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "both")
    assert sinks("log")["stdout"] == {SCREEN, LOG}


@pytest.mark.parametrize(
    ("output", "words"),
    [
        ("sceen", "did you mean 'screen'?"),
        ({"stdot": "screen"}, "did you mean 'stdout'?"),
        ({"stdout": "scren"}, "did you mean 'screen'?"),
        (3, "of type int"),
    ],
)
def test_words_that_mean_nothing(output, words):
    with pytest.raises(LaunchError) as error:
        sinks(output)
    assert words in str(error.value)


def test_files_of_its_own():
    output = ProcessOutput("robot-1", "own_log", cached=False, line_format=None)
    output.feed("stdout", b"one\n")
    output.feed("stderr", b"two\n")
    output.feed("stdout", b"three")
    output.close()
    folder = Path(launch_logging.launch_config.log_dir)
    texts = {path.name: path.read_text() for path in folder.glob("robot-1*")}
    assert texts == {
        "robot-1-stdout.log": "[robot-1] one\n[robot-1] three\n",
        "robot-1-stderr.log": "[robot-1] two\n",
        "robot-1.log": "[robot-1] one\n[robot-1] two\n[robot-1] three\n",
    }


def test_output_without_any_newline_is_not_kept_for_ever(capsys):
    output = ProcessOutput("robot-1", "screen", cached=False, line_format=None)
    for _ in range(100):
        output.feed("stdout", b"x" * 10000)
    seen = capsys.readouterr().out
    output.close()
    assert 900_000 < seen.count("x") < 1_000_000
    assert (seen + capsys.readouterr().out).count("x") == 1_000_000
