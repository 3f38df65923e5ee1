"""ExecuteProcess: the messages about processes that cannot be started."""

import pytest

from gz_course.sim.ros.launch.actions import ExecuteProcess, Shutdown


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"cmd": []}, "the command is empty"),
        ({"cmd": ["true"], "prefix": "'"}, "cannot be split"),
        ({"cmd": ["true"], "additional_env": {"A=B": "1"}}, "cannot be set"),
    ],
)
def test_what_has_no_command_ends_the_launch(run, options, words):
    result = run(ExecuteProcess(cmd=["sleep", "1000"]), ExecuteProcess(**options))
    assert result.code == 1
    (said,) = (line for line in result.lines if "Caught exception in launch" in line)
    assert words in said
    assert f"{__file__}:" in said, "the place where the action was made"
    assert "Traceback" not in result.text


def test_what_cannot_be_started_fails_alone(run, tmp_path):
    (tmp_path / "text").touch()
    (tmp_path / "program").write_text("text")
    (tmp_path / "program").chmod(0o755)
    mistakes = [
        ({"cmd": ["no-such-program"]}, "there is no program 'no-such-program' to be started"),
        ({"cmd": ["slep", "1"]}, "there is no program 'slep' to be started; did you mean 'sleep'?"),
        ({"cmd": [f"{tmp_path}/text/below"]}, f"there is no program '{tmp_path}/text/below' to be started"),
        ({"cmd": ["true"], "cwd": "/no/such/folder"}, "in the folder '/no/such/folder', which does not exist"),
        ({"cmd": [f"{tmp_path}/text"]}, "not executable"),
        ({"cmd": [f"{tmp_path}/program"]}, "its first line must be #!"),
        ({"cmd": ["a\0b"]}, "null byte"),
    ]
    wrong = [ExecuteProcess(respawn=True, on_exit=Shutdown(), **options) for options, _ in mistakes]
    result = run(*wrong, ExecuteProcess(cmd=["echo", "runs"], output="screen"))
    assert (result.code, result.printed_by("echo")) == (0, ["runs"])
    errors = [line for line in result.lines if line.startswith("[ERROR] [")]
    assert len(errors) == len(mistakes)
    for (options, words), said in zip(mistakes, errors, strict=True):
        label = options["cmd"][0].rpartition("/")[2]
        assert said.startswith(f"[ERROR] [{label}-") and words in said
        assert f"{__file__}:" in said, "the place where the action was made"
    assert "Traceback" not in result.text


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"cmd": "ls -l"}, r"cmd=\['ls', '-l'\], or add shell=True"),
        ({"cmd": ["ls"], "outptu": "screen"}, "ExecuteProcess has no argument 'outptu'; did you mean 'output'"),
        ({"cmd": ["ls"], "condition": True}, "IfCondition"),
        ({"cmd": [3]}, "3 is of type int"),
        ({"cmd": ["ls"], "on_exit": 3}, "on_exit is 3"),
        ({"cmd": ["ls"], "on_exit": ["a"]}, "on_exit holds 'a' of type str"),
    ],
)
def test_arguments_that_make_no_sense(options, words):
    with pytest.raises(Exception, match=words):
        ExecuteProcess(**options)


def test_an_action_is_executed_once_only(run):
    action = ExecuteProcess(cmd=["true"])
    result = run(action, action)
    assert result.code == 1
    assert "an action can only be executed once, make another one" in result.text
