import signal
import subprocess
import sys
from importlib import metadata

import pytest

from gz_course.sim import gz
from gz_course.sim.gz import command


@pytest.fixture
def count(tmp_path, monkeypatch):
    """Return a sub-command `count` among the commands of another package, whose options are parsed."""
    folder = tmp_path / "gz" / "numbers" / "commands"
    folder.mkdir(parents=True)
    (folder / "__init__.py").write_text("")
    (folder / "count.py").write_text(
        '"""Counts."""\n'
        "def add_arguments(parser):\n"
        "    parser.add_argument('--to', type=int)\n"
        "    parser.add_argument('--from', dest='start', type=int)\n"
        "    parser.commands('--to')\n"
        "    parser.needs('--to', '--from')\n"
        "def run(values):\n"
        "    if values.to < values.start:\n"
        "        raise ValueError('downwards')\n"
        "    if values.to == values.start:\n"
        "        raise KeyboardInterrupt\n"
        "    print(*range(values.start, values.to))\n"
        "    return 3\n"
    )
    monkeypatch.setattr(gz, "__path__", [*gz.__path__, str(tmp_path / "gz")])
    for name in (
        "gz_course.sim.gz.numbers",
        "gz_course.sim.gz.numbers.commands",
        "gz_course.sim.gz.numbers.commands.count",
    ):
        monkeypatch.delitem(sys.modules, name, raising=False)


@pytest.mark.parametrize(
    ("arguments", "code", "output", "error"),
    [
        (["--from", "1", "--to", "4"], 3, "1 2 3\n", ""),
        (["--from", "4", "--to", "1"], 1, "", "gz count: downwards\n"),
        (["--from", "4", "--to", "4"], 130, "", ""),
    ],
)
def test_a_sub_command_among_commands_is_run_with_its_options(count, capsys, arguments, code, output, error):
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    assert command.main(["count", *arguments]) == code
    assert capsys.readouterr() == (output, error)
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--to", "1"], 107, "--to requires --from"),
        (["--form", "1"], 109, "did you mean '--from'?"),
        (["--to"], 114, "--to"),
        (["--to", "x"], 104, "'x'"),
    ],
)
def test_wrong_options_are_one_line_and_the_code_of_gazebo(count, capsys, arguments, code, words):
    with pytest.raises(SystemExit) as end:
        command.main(["count", *arguments])
    out, error = capsys.readouterr()
    assert (end.value.code, out, error.count("\n")) == (code, "", 1)
    assert error.startswith("gz count: ")
    assert words in error


def test_a_sub_command_without_anything_to_do_prints_its_help(count, capsys):
    with pytest.raises(SystemExit) as end:
        command.main(["count", "--from", "1"])
    assert not end.value.code
    assert "Counts." in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"]])
def test_help_lists_sub_commands_without_importing_them(count, capsys, arguments):
    assert command.main(arguments) == 0
    out = capsys.readouterr().out
    assert any(line.split() == ["count", "Counts."] for line in out.splitlines())
    assert "gz.numbers" not in sys.modules


@pytest.mark.parametrize(
    ("wrong", "code", "words"),
    [
        ("cuont", 2, "there is no command 'cuont'; did you mean 'count'?"),
        ("--version5", 109, "there is no option '--version5'; did you mean '--versions'?"),
        ("xyzzy", 2, "see gz --help"),
    ],
)
def test_an_unknown_sub_command_is_one_sentence_and_a_code(count, capsys, wrong, code, words):
    assert command.main([wrong]) == code
    out, error = capsys.readouterr()
    assert (out, error.count("\n")) == ("", 1)
    assert error.startswith("gz: ") and words in error


@pytest.mark.parametrize("name", command.find_commands())
def test_an_unknown_option_is_one_sentence_and_one_code_for_every_command(name, capsys):
    with pytest.raises(SystemExit) as end:
        command.main([name, "--hepl"])
    out, error = capsys.readouterr()
    assert (end.value.code, out) == (109, "")
    assert error == f"gz {name}: there is no option '--hepl'; did you mean '--help'?\n"


def test_versions_names_the_engines(capsys):
    assert command.main(["--versions"]) == 0
    out = capsys.readouterr().out
    assert "mujoco " in out
    assert "pyzmq " in out


def test_the_installed_command_answers():
    done = subprocess.run(
        [sys.executable, "-m", "gz_course.sim.gz.command"], capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0


@pytest.mark.parametrize("name", command.find_commands())
def test_every_command_has_its_version(name, capsys):
    with pytest.raises(SystemExit) as ended:
        command.main([name, "--versions"])
    assert (ended.value.code, capsys.readouterr().out) == (0, f"{metadata.version('gz-ros2-course')}\n")
