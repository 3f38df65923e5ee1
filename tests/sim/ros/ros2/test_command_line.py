"""The `ros2` command: help, unknown words, and handing over to a real ros2."""

import argparse
import sys

import pytest

from gz_course.sim.ros.ros2.command_line import COMMANDS, found, load, main, run
from gz_course.sim.ros.ros2.hand_over import environment_without_wheels


@pytest.mark.parametrize("arguments", [[], ["--help"]])
def test_without_a_command_it_lists_them_all(ros2, arguments):
    code, text, errors = ros2(*arguments)
    assert (code, errors) == (0, "")
    assert all(f"\n  {name} " in text for name in found(COMMANDS))
    assert "Various topic related sub-commands." in text


def test_a_command_without_verb_lists_its_verbs(ros2):
    code, text, errors = ros2("topic")
    assert (code, errors) == (0, "")
    assert "\n  echo   Output messages from a topic.\n" in text


VERBS = [
    [path.stem] if path.suffix else [path.name, verb]
    for path in found(COMMANDS).values()
    for verb in ([""] if path.suffix else found(path))
]


@pytest.mark.parametrize("words", VERBS, ids=" ".join)
def test_every_verb_has_help_with_a_sentence_for_each_option(words, capsys):
    path = COMMANDS.joinpath(*words)
    module = load(path if path.is_dir() else path.with_suffix(".py"))
    parser = argparse.ArgumentParser(prog=f"ros2 {' '.join(words)}")
    module.add_arguments(parser)
    with pytest.raises(SystemExit) as ended:
        parser.parse_args(["--help"])
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: ros2 {' '.join(words)} [-h]")
    assert all(action.help for action in parser._actions), "an option without help"
    assert callable(module.main)


def test_an_unknown_option_is_exit_code_2_in_every_verb(capsys):
    for words in VERBS:
        with pytest.raises(SystemExit) as ended:
            run(COMMANDS, "ros2", [*filter(None, words), "--nonsense"])
        assert ended.value.code == 2, words
        assert f"{' '.join(words).strip()}: error: " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["tpic"], "); did you mean 'topic'?"),
        (["topic", "ecoh"], "ros2 topic: error: invalid choice: 'ecoh'"),
        (["pkg", "list", "extra"], "ros2 pkg list: error: unrecognized arguments: extra"),
        (["topic", "--nonsense"], "ros2 topic: error: unrecognized arguments: --nonsense"),
        (["topic", "list", "--cuont-topics"], "unrecognized arguments: --cuont-topics; did you mean '--count-topics'?"),
        (["run", "ros_gz_bridge"], "ros2 run: error: the following arguments are required: executable_name\n"),
        (["launch"], "ros2 launch: error: the following arguments are required: package_name\n"),
    ],
)
def test_wrong_usage_is_exit_code_2(ros2, arguments, words):
    code, text, errors = ros2(*arguments)
    assert (code, text) == (2, "")
    assert words in errors


@pytest.mark.parametrize("words", VERBS, ids=" ".join)
def test_unknown_options_and_missing_arguments_are_wrong_usage_in_every_verb(words, capsys, monkeypatch):
    monkeypatch.setattr("gz_course.sim.ros.ros2.command_line.hand_over", lambda arguments: None)
    monkeypatch.setattr("gz_course.sim.ros.ros2.interruption.listen", lambda: None)
    with pytest.raises(SystemExit) as ended:
        main([*filter(None, words), "--nonsense"])
    written = capsys.readouterr().err
    command = " ".join(["ros2", *filter(None, words)])
    assert ended.value.code == 2
    assert written.startswith(f"usage: {command} [-h]")
    last = written.splitlines()[-1]
    assert last.startswith(
        (f"{command}: error: unrecognized", f"{command}: error: the following arguments are required")
    )


def test_a_verb_is_found_by_its_file_alone(tmp_path):
    (tmp_path / "__init__.py").touch()
    (tmp_path / "bag.py").touch()
    (tmp_path / "action").mkdir()
    (tmp_path / "__pycache__").mkdir()
    assert list(found(tmp_path)) == ["action", "bag"]


def test_a_sourced_ros_takes_over(ros2, tmp_path):
    program = tmp_path / "bin/ros2"
    marker = tmp_path / "share/ament_index/resource_index/packages/ros2cli"
    for path in (program, marker):
        path.parent.mkdir(parents=True)
        path.touch()
    program.write_text('#!/bin/sh\necho "real: $* guard=$_ROS_WHEELS_BOOTSTRAP_COMPLETE $LD_LIBRARY_PATH"\nexit 5\n')
    program.chmod(0o755)
    code, text, _ = ros2("topic", "list", environment={"AMENT_PREFIX_PATH": str(tmp_path), "LD_LIBRARY_PATH": ""})
    assert (code, text) == (5, "real: topic list guard= \n")


def test_a_ros2cli_of_the_same_python_takes_over(ros2, tmp_path):
    (tmp_path / "ros2cli").mkdir()
    (tmp_path / "ros2cli/__init__.py").touch()
    (tmp_path / "ros2cli/cli.py").write_text("def main(*, argv):\n    print('real', argv)\n    return 6\n")
    code, text, _ = ros2("topic", "list", environment={"PYTHONPATH": str(tmp_path)})
    assert (code, text) == (6, "real ['topic', 'list']\n")


def test_our_own_fault_is_one_sentence(monkeypatch, capsys):
    monkeypatch.setattr("signal.signal", lambda number, handler: None)
    monkeypatch.setattr("gz_course.sim.ros.ros2.command_line.hand_over", lambda arguments: None)
    monkeypatch.setattr("sys.stdout.reconfigure", lambda **options: None, raising=False)
    monkeypatch.setattr("gz_course.sim.ros.ros2.command_line.run", lambda *arguments: 1 / 0)
    assert main(["topic"]) == 1
    assert capsys.readouterr().err == "ros2: internal error: ZeroDivisionError: division by zero\n"


def test_only_the_libraries_of_this_environment_are_left_behind():
    environment = {
        "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
        "LD_LIBRARY_PATH": f"{sys.prefix}/lib:/opt/vendor/lib:{sys.prefix}/lib/python/ros_x.libs",
        "HOME": "/h",
    }
    assert environment_without_wheels(environment) == {"LD_LIBRARY_PATH": "/opt/vendor/lib", "HOME": "/h"}
