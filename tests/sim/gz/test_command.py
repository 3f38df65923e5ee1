import subprocess
import sys

import pytest

import gz
from gz import command


@pytest.fixture
def hello(tmp_path, monkeypatch):
    """A sub-command `hello` in a folder of its own, as another installed package would bring it."""
    folder = tmp_path / "gz" / "hello"
    folder.mkdir(parents=True)
    (folder / "command.py").write_text(
        '"""Greets."""\nprint("imported")\n\ndef main(argv):\n    print("hello", *argv)\n    return len(argv)\n'
    )
    monkeypatch.setattr(gz, "__path__", [*gz.__path__, str(tmp_path / "gz")])
    monkeypatch.delitem(sys.modules, "gz.hello", raising=False)
    monkeypatch.delitem(sys.modules, "gz.hello.command", raising=False)


def test_a_sub_command_is_found_and_called(hello, capsys):
    assert command.main(["hello", "big", "world"]) == 2
    assert capsys.readouterr().out == "imported\nhello big world\n"


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"]])
def test_help_lists_sub_commands_without_importing_them(hello, capsys, arguments):
    assert command.main(arguments) == 0
    out = capsys.readouterr().out
    assert any(line.split() == ["hello", "Greets."] for line in out.splitlines())
    assert "imported" not in out


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ("helo", "did you mean `gz hello`?"),
        ("--version5", "did you mean `gz --versions`?"),
        ("xyzzy", "gz --help"),
    ],
)
def test_an_unknown_sub_command_is_one_sentence_and_exit_code_2(hello, capsys, wrong, words):
    assert command.main([wrong]) == 2
    out, error = capsys.readouterr()
    assert (out, error.count("\n")) == ("", 1)
    assert repr(wrong) in error
    assert words in error


def test_versions_names_the_engines(capsys):
    assert command.main(["--versions"]) == 0
    out = capsys.readouterr().out
    assert "mujoco " in out
    assert "pyzmq " in out


def test_the_installed_command_answers():
    done = subprocess.run([sys.executable, "-m", "gz.command"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0
