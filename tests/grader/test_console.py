"""The console of commands: colours of its own, and no control codes of others."""

import ast
import io
from pathlib import Path

from gz_course.grader.console import GuardedConsole

GRADER = Path(__file__).parents[2] / "grader"


def test_colours_are_written_and_control_codes_of_names_are_not():
    out = io.StringIO()
    console = GuardedConsole(file=out, force_terminal=True, color_system="standard", width=40)
    console.print("[red]FAIL[/red]  \x1b]0;owned\x07\x1b[2J\x9b31m\ry", highlight=False)
    assert (
        out.getvalue() == "\x1b[31mFAIL\x1b[0m  \ufffd]0;owned\ufffd[2J\ufffd31my\n"
    )  # rich drops what moves a cursor


def bare_consoles(text):
    """The calls in a file that have rich write to a console of its own."""
    calls = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)] if "from rich" in text else []
    named = [(ast.unparse(node.func).rpartition(".")[2], {each.arg for each in node.keywords}) for node in calls]
    return [name for name, given in named if name == "Console" or (name == "Progress" and "console" not in given)]


def test_every_command_prints_to_such_a_console():
    found = {str(path.relative_to(GRADER)): bare_consoles(path.read_text()) for path in GRADER.rglob("*.py")}
    assert {name: calls for name, calls in found.items() if calls} == {}
    assert bare_consoles("from rich.progress import Progress\nProgress(transient=True)") == ["Progress"]
