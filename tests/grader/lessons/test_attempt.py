"""A reader's cell, however wrong, gets one sentence and harms nothing after it."""

import contextlib
import io
import os
import signal
from pathlib import Path

import pytest

from gz_course.grader.lessons import cell
from gz_course.grader.lessons.attempt import attempt
from gz_course.grader.lessons.cell import MOST_OUTPUT, UNTOUCHED, untouched
from gz_course.grader.lessons.step import COMMANDS, PYTHON, Step, Tried, expect
from gz_course.grader.tools.playground import Playground


@pytest.fixture
def room():
    with Playground() as room:
        yield room


def doubles(tried: Tried) -> str:
    """double(x) is twice x."""
    said = tried.function("double")(3)
    expect(said == 6, f"double(3) is {said}; 6 is wanted.")
    return "double(3) is 6."


def nothing(_: Tried) -> str:
    """Anything will do."""
    return "It ended."


def broken(_: Tried) -> str:
    """A check with a fault."""
    raise KeyError("lidar")


def tried(room, body, check=nothing, *, form=PYTHON, names=None, folder=None, limit=60.0):
    """Return the answer to a cell and what was printed."""
    names = {"room": room} if names is None else names
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        answer = attempt(Step("try", 1, form, check, limit), body, names, room, folder or Path.cwd(), lambda text: text)
    return answer, printed.getvalue()


@pytest.mark.parametrize(
    "body", ["...", "x = ...", "def f(a):\n    ...", "", "drive(ahead=..., turn=0.1)", "x = ... +"]
)
def test_dots_are_untouched(room, body):
    answer, _ = tried(room, body)
    assert (answer.done, answer.seen) == (False, UNTOUCHED)


@pytest.mark.parametrize("body", ["x = a[..., 0]", "s = 'wait...'", "# ... and so on\nx = 1", "x = a[0, ...]"])
def test_dots_that_are_python_are_no_gap(body):
    assert not untouched(body, PYTHON)


def test_commands_and_files_with_dots_are_untouched():
    assert untouched("ros2 topic pub ... --once", COMMANDS)
    assert untouched("- ros_topic_name: ...\n", "bridge.yaml")
    assert not untouched("ls ../../exercises", COMMANDS)


def test_a_right_cell_is_done(room):
    answer, _ = tried(room, "def double(x):\n    return 2 * x", doubles)
    assert (answer.done, str(answer)) == (True, "\u2714 Done. double(3) is 6.")


def test_a_wrong_cell_is_told_what_was_seen(room):
    answer, _ = tried(room, "def double(x):\n    return x", doubles)
    assert (answer.done, answer.seen) == (False, "double(3) is 3; 6 is wanted.")


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("x = 1\ny = x / 0", "Line 2, `y = x / 0`, raises ZeroDivisionError: division by zero."),
        ("def double(x)\n    return x", "Line 1 is no Python: expected ':'."),
        ("raise SystemExit", "The cell ends the program"),
        ("exit()", "ends the program"),
        ("raise KeyboardInterrupt", "The cell was interrupted."),
    ],
)
def test_what_a_cell_raises_is_one_sentence(room, body, says):
    answer, printed = tried(room, body)
    assert not answer.done
    assert says in answer.seen
    assert "Traceback" not in printed


def test_what_its_function_raises_is_told_with_its_line(room):
    answer, _ = tried(room, "def double(x):\n    return x.twice", doubles)
    assert answer.seen.startswith("Line 2, `return x.twice`, raises AttributeError")


@pytest.mark.parametrize(
    "body",
    ["while True:\n    pass", "while True:\n    try:\n        while True: pass\n    except Exception:\n        pass"],
)
def test_a_loop_without_end_is_ended(room, body):
    answer, _ = tried(room, body, limit=1.0)
    assert answer.seen.startswith("The cell had not ended after 1 s")


def test_a_function_without_end_is_ended(room):
    answer, _ = tried(room, "def double(x):\n    while True:\n        x += 1", doubles, limit=1.0)
    assert answer.seen.startswith("The cell had not ended after 1 s")


def test_a_command_without_end_is_ended_with_what_it_started(room):
    answer, _ = tried(room, "sleep 1000 & sleep 1000", form=COMMANDS, limit=6.0)
    assert answer.seen.startswith("The command had not ended after 2 s")


def test_a_command_may_begin_as_in_other_cells_of_a_notebook(room):
    answer, printed = tried(room, "!echo one\n  !echo two\necho three!", form=COMMANDS)
    assert answer.done and printed.split() == ["one", "two", "three!"]


def test_a_command_on_a_crowded_machine_gets_its_time_again_and_no_other_sentence(room, monkeypatch):
    crowded = iter([True, True, True, False])
    monkeypatch.setattr(cell, "crowded", lambda: next(crowded))
    answer, _ = tried(room, "sleep 1000", form=COMMANDS, limit=0.3)
    assert answer.seen.startswith("The command had not ended after 0.1 s")
    assert next(crowded, None) is None


def test_a_megabyte_is_cut(room):
    answer, printed = tried(room, "print('x' * 1_000_000)")
    assert answer.done
    assert len(printed) < MOST_OUTPUT + 100
    assert "980,001 more characters" in printed


def test_the_playground_is_put_back(room):
    names = {"room": room}
    answer, _ = tried(room, "room = 'kitchen'", names=names)
    assert names["room"] is room
    assert answer.notes == ("The cell gave `room` another value; it is the playground again.",)


def test_the_folder_is_put_back(room, tmp_path):
    before = Path.cwd()
    answer, _ = tried(room, f"import os\nos.chdir({str(tmp_path)!r})")
    assert Path.cwd() == before
    assert "folder" in answer.notes[0]


def test_a_program_that_the_cell_killed_is_named(room):
    program = room.start("sleep 1000")
    names = {"room": room, "os": os, "program": program, "signal": signal}
    answer, _ = tried(room, "os.kill(program.pid, signal.SIGKILL)\nprogram._process.wait()", names=names)
    assert answer.notes == ("`sleep 1000` was ended by SIGKILL; run the cell that starts it again.",)


def test_a_program_that_the_cell_stopped_is_not_named(room):
    program = room.start("sleep 1000")
    answer, _ = tried(room, "program.stop()", names={"room": room, "program": program})
    assert answer.notes == ()


def test_a_fault_of_the_check_is_not_the_readers(room):
    answer, _ = tried(room, "x = 1", broken)
    assert answer.seen.startswith("The check of this cell has a fault of its own (KeyError: 'lidar')")


def test_a_cell_of_a_file_writes_it(room, tmp_path):
    tried(room, "- topic_name: /clock", form="bridge.yaml", folder=tmp_path)
    assert (tmp_path / "bridge.yaml").read_text() == "- topic_name: /clock\n"


def test_what_a_program_said_is_there_after_it_has_ended(room):
    def asks(tried: Tried) -> str:
        """Return what the client said, and not what one before it said."""
        room.start("echo the one before").wait_for("before")
        room.start("echo response: 3")._process.wait()
        return tried.stop("echo")

    answer, _ = tried(room, "x = 1", asks)
    assert answer.seen == "response: 3\n"
