"""ExecuteProcess: the started command, the output, the end."""

import contextlib
import os
import re
import signal
import sys
import threading

import psutil
import pytest

from gz_course.sim.ros.launch import LaunchDescription, LaunchService
from gz_course.sim.ros.launch.actions import (
    EmitEvent,
    ExecuteLocal,
    ExecuteProcess,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
)
from gz_course.sim.ros.launch.descriptions import Executable
from gz_course.sim.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from gz_course.sim.ros.launch.events.process import (
    ProcessStdin,
    ShutdownProcess,
    SignalProcess,
    matches_executable,
    matches_name,
)
from gz_course.sim.ros.launch.substitutions import LaunchConfiguration, LocalSubstitution
from gz_course.tests.descriptors import own_descriptors


def sh(script, *words, **options):
    return ExecuteProcess(cmd=["sh", "-c", script, "sh", *words], **{"output": "screen", **options})


def when_printed(action, word, *entities):
    """Answer once when a process prints a word."""
    seen, answered = [], []

    def look(event):
        seen.append(event.text)
        if word.encode() not in b"".join(seen) or answered:
            return None
        answered.append(True)
        return list(entities)

    return RegisterEventHandler(OnProcessIO(target_action=action, on_stdout=look))


def test_the_lines_of_a_life(run):
    result = run(ExecuteProcess(cmd=["printf", "a\\nb"], output="screen"), LogInfo(msg="visited"))
    pid = result.lines[1].partition("pid [")[2].rstrip("]")
    assert result.lines == [
        "[INFO] [launch.user]: visited",
        f"[INFO] [printf-1]: process started with pid [{pid}]",
        "[printf-1] a",
        "[printf-1] b",
        f"[INFO] [printf-1]: process has finished cleanly [pid {pid}]",
    ]
    assert result.code == 0
    first, second = result.text.splitlines()[:2]
    assert first.startswith("[INFO] [launch]: All log files can be found below ")
    assert second == "[INFO] [launch]: Default logging verbosity is set to INFO"


@pytest.mark.parametrize(("end", "code"), [("exit 3", 3), ("kill -9 $$", -9)])
def test_a_death_is_told_and_is_no_failure_of_the_launch(run, end, code):
    action = sh(end)
    result = run(action)
    pid = action.process_details["pid"]
    assert result.code == 0
    assert result.lines[-1] == (
        f"[ERROR] [sh-1]: process has died [pid {pid}, exit code {code}, cmd 'sh -c {end} sh']."
    )
    assert action.return_code == code


def test_words_stay_apart_and_substitutions_are_performed(run):
    words = ["a b", "", LaunchConfiguration("x"), ["c", LaunchConfiguration("x")], "$HOME", "*"]
    result = run(sh('for word; do echo "<$word>"; done', *words), arguments={"x": "'1'"})
    assert result.printed_by("sh") == ["<a b>", "<>", "<'1'>", "<c'1'>", "<$HOME>", "<*>"]


def test_a_shell_gets_the_words_joined(run):
    result = run(ExecuteProcess(cmd=["echo", "$WHERE", "|", "cat"], shell=True, output="screen", name="piped",
                                additional_env={"WHERE": ["he", "re"]}))  # fmt: skip
    assert result.printed_by("piped") == ["here"]
    assert run(ExecuteProcess(cmd="echo a; echo b", shell=True, output="screen", name="x")).printed_by("x") == [
        "a",
        "b",
    ]


def test_folder_and_environment(run, tmp_path, monkeypatch):
    monkeypatch.setenv("INHERITED", "yes")
    result = run(
        sh("pwd", cwd=str(tmp_path)),
        sh('echo "$INHERITED$ADDED"', additional_env={"ADDED": "too"}),
        sh('echo "$INHERITED$ADDED$ONLY"', env={"ONLY": "this", "PATH": os.environ["PATH"]}),
    )
    assert sorted(result.printed_by("sh")) == sorted([str(tmp_path), "yestoo", "this"])


def test_labels_count_all_processes_of_a_launch(run):
    result = run(sh("echo a"), ExecuteProcess(cmd=["echo", "b"], output="screen", name="talker"))
    assert {line.partition("]")[0] for line in result.lines if line.startswith(("[sh", "[talker"))} == {
        "[sh-1",
        "[talker-2",
    }


def test_output_is_printed_before_the_end_is_told(run):
    numbers = "\n".join(map(str, range(20000)))
    result = run(sh("seq 0 19999; echo last >&2"))
    assert "\n".join(line for line in result.printed_by("sh") if line != "last") == numbers
    assert result.lines[-1].startswith("[INFO] [sh-1]: process has finished cleanly")


FULL_PIPE = """\
import fcntl, os
fcntl.fcntl(1, fcntl.F_SETPIPE_SZ, 1 << 20)
os.write(1, b"".join(b"%d\\n" % number for number in range(100000)))
"""


def test_a_full_pipe_is_read_before_the_end_is_told(run):
    result = run(ExecuteProcess(cmd=[sys.executable, "-S", "-c", FULL_PIPE], name="full", output="screen"))
    assert result.printed_by("full") == [str(number) for number in range(100000)]
    assert result.lines[-1].startswith("[INFO] [full-1]: process has finished cleanly")


def test_only_stderr_reaches_the_screen_by_default(run, log_folder):
    result = run(ExecuteProcess(cmd=["sh", "-c", "echo out; echo err >&2"]))
    assert result.printed_by("sh") == ["err"]
    (log,) = (path.read_text() for path in log_folder.glob("*-*/launch.log"))
    assert "[sh-1] out\n" in log and "[sh-1] err\n" in log


def test_a_format_for_its_lines(run):
    result = run(sh("echo hello", output_format="{this.process_description.final_name} says {line}"))
    assert "sh-1 says hello" in result.lines


def test_a_terminal_is_emulated_when_asked(run):
    script = "test -t 1 && test -t 2 && echo terminal || echo pipe"
    assert run(sh(script)).printed_by("sh") == ["pipe"]
    assert run(sh(script, emulate_tty=True)).printed_by("sh") == ["terminal"]
    assert run(sh(script), arguments={"emulate_tty": "true"}).printed_by("sh") == ["terminal"]


def test_output_can_be_kept(run):
    action = sh("echo out; echo err >&2", cached_output=True)
    run(action)
    assert (action.get_stdout(), action.get_stderr()) == ("out\n", "err\n")


def test_a_prefix_goes_before_the_command(run):
    result = run(sh('echo "$A"', prefix="env 'A=b c'"))
    assert result.printed_by("env") == ["b c"]
    result = run(sh('echo "$A"'), ExecuteProcess(cmd=["echo", "plain"], output="screen"),
                 arguments={"launch-prefix": "env A=x", "launch-prefix-filter": "sh$"})  # fmt: skip
    assert result.printed_by("env") == ["x"]
    assert result.printed_by("echo") == ["plain"]


def test_its_command_is_told_when_asked(run, tmp_path):
    result = run(ExecuteProcess(cmd=["true"], log_cmd=True, cwd=str(tmp_path), additional_env={"A": "1"}))
    assert result.lines[0] == f"[INFO] [true-1]: process details: cmd='true', cwd='{tmp_path}', custom_env?=True"


def test_its_end_is_answered(run):
    action = sh("exit 3", on_exit=[LogInfo(msg=["ended with ", LocalSubstitution("event.returncode")])])
    assert "[INFO] [launch.user]: ended with 3" in run(action).lines
    seen = []
    run(sh("exit 4", on_exit=lambda event, context: seen.append((event.returncode, event.process_name, event.cmd))))
    assert seen == [(4, "sh-1", ["sh", "-c", "exit 4", "sh"])]


def test_a_required_process(run):
    result = run(sh("exit 0", on_exit=Shutdown(reason="over")), sh("exec sleep 1000"))
    assert "[INFO] [launch]: process[sh-1] was required: shutting down launched system" in result.lines
    assert "[INFO] [sh-2]: sending signal 'SIGINT' to process[sh-2]" in result.lines
    assert result.code == 0


def test_event_handlers_see_start_output_and_end(run):
    seen = []
    action = sh("echo hello")
    other = sh("true")

    def note(what):
        return lambda event, context: seen.append((what, event.action is action, event.pid))

    result = run(
        RegisterEventHandler(OnProcessStart(target_action=action, on_start=note("start"))),
        RegisterEventHandler(OnProcessExit(target_action=lambda each: each is action, on_exit=note("exit"))),
        RegisterEventHandler(OnProcessIO(target_action=action, on_stdout=lambda event: seen.append(event.text))),
        action,
        other,
    )
    assert result.code == 0
    pid = action.process_details["pid"]
    assert seen == [("start", True, pid), b"hello\n", ("exit", True, pid)]


def test_respawn(run, tmp_path):
    result = run(sh(f"echo x >> {tmp_path}/runs; exit 1", respawn=True, respawn_delay=0.01, respawn_max_retries=2))
    assert (tmp_path / "runs").read_text() == "x\nx\nx\n"
    assert sum("process has died" in line for line in result.lines) == 3
    assert {line.partition(":")[0] for line in result.lines} == {"[INFO] [sh-1]", "[ERROR] [sh-1]"}


def test_what_it_has_left_is_gone_before_it_is_started_again(run):
    result = run(sh("sleep 1000 & exit 1", respawn=True, respawn_max_retries=1))
    assert sum("process has died" in line for line in result.lines) == 2


def test_a_shutdown_ends_respawning_even_while_it_waits(run):
    action = sh("exit 1", respawn=True, respawn_delay=1000.0)
    result = run(action, RegisterEventHandler(OnProcessExit(target_action=action, on_exit=[Shutdown()])))
    assert result.code == 0
    assert sum("process started" in line for line in result.lines) == 1


def stubborn(*ignored, **options):
    handlers = "".join(f"signal.signal(signal.{name}, signal.SIG_IGN)\n" for name in ignored)
    code = f"import signal\n{handlers}print('up', flush=True)\nwhile True: signal.pause()"
    return ExecuteProcess(cmd=[sys.executable, "-S", "-c", code], name="stubborn", output="screen", **options)


def test_who_ignores_sigint_gets_sigterm(run):
    action = stubborn("SIGINT", sigterm_timeout="0.05")
    result = run(action, when_printed(action, "up", Shutdown()))
    assert action.return_code == -signal.SIGTERM
    said = [line for line in result.lines if "signal 'SIG" in line or "escalating" in line]
    assert said == [
        "[INFO] [stubborn-1]: sending signal 'SIGINT' to process[stubborn-1]",
        "[ERROR] [stubborn-1]: process[stubborn-1] failed to terminate '0.05' seconds after receiving 'SIGINT', "
        "escalating to 'SIGTERM'",
        "[INFO] [stubborn-1]: sending signal 'SIGTERM' to process[stubborn-1]",
    ]


def test_who_ignores_both_gets_sigkill(run):
    action = stubborn("SIGINT", "SIGTERM")
    result = run(
        action, when_printed(action, "up", Shutdown()), arguments={"sigterm_timeout": "0.05", "sigkill_timeout": "0.1"}
    )
    assert action.return_code == -signal.SIGKILL
    assert "seconds after receiving 'SIGTERM', escalating to 'SIGKILL'" in result.text
    assert "'0.1' seconds" in result.text


def test_a_time_out_that_is_no_number(run):
    result = run(sh("true"), arguments={"sigterm_timeout": "soon"})
    assert result.code == 1
    assert "the time 'soon' is no number of seconds" in result.lines[-1]


def test_all_that_a_shell_has_started_ends_with_it(run):
    """The shell's background job ignores SIGINT, as POSIX requires, and is not our child."""
    action = ExecuteProcess(
        cmd="sleep 1000 & echo $! up; (sleep 1001 | cat); true", shell=True, output="screen", name="job"
    )
    result = run(action, when_printed(action, "up", Shutdown()))
    (line,) = result.printed_by("job")
    with contextlib.suppress(psutil.NoSuchProcess):  # its new parent may not have reaped it yet
        assert psutil.Process(int(line.split()[0])).status() == psutil.STATUS_ZOMBIE
    assert result.code == 0


def test_what_is_left_in_the_background_is_waited_for(run):
    action = ExecuteProcess(cmd="(sleep 0.1; echo late) & echo early", shell=True, output="screen", name="job")
    result = run(action)
    assert result.printed_by("job") == ["early", "late"]
    assert any("has left processes in the background" in line for line in result.lines)


def test_old_kernels_have_no_pidfd(run, monkeypatch):
    def refuse(pid):
        raise PermissionError

    monkeypatch.setattr(os, "pidfd_open", refuse)
    assert run(sh("echo a; exit 3")).printed_by("sh") == ["a"]


LISTENER = """\
import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)  # Python's own could come just before pause()
signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGUSR1})  # a handler would not run if it came just before readline()
os.write(1, b"up\\n")
signal.sigwait({signal.SIGUSR1})
os.write(1, b"heard\\n")
line = sys.stdin.readline()
os.write(1, b"read " + line.encode())
signal.pause()
"""


def test_signals_and_input_on_demand(run):
    action = ExecuteProcess(cmd=[sys.executable, "-S", "-c", LISTENER], name="listener", output="screen")
    poke = SignalProcess(signal_number="SIGUSR1", process_matcher=matches_name("listener"))
    end = ShutdownProcess(process_matcher=matches_executable(sys.executable))

    def talk(context):
        return EmitEvent(event=ProcessStdin(text=b"words\n", action=action, **action.process_details))

    result = run(
        action,
        when_printed(action, "up", EmitEvent(event=poke)),
        when_printed(action, "heard", OpaqueFunction(function=talk)),
        when_printed(action, "read", EmitEvent(event=end)),
    )
    assert result.printed_by("listener")[:3] == ["up", "heard", "read words"]
    assert "[INFO] [listener-1]: sending signal 'SIGUSR1' to process[listener-1]" in result.lines
    assert result.code == 0


def test_input_for_who_does_not_read_is_lost(run):
    action = sh("exec <&-; echo up; exec sleep 1000")

    def talk(context):
        return [EmitEvent(event=ProcessStdin(text=b"words\n", action=action, **action.process_details)), Shutdown()]

    result = run(action, when_printed(action, "up", OpaqueFunction(function=talk)))
    assert result.code == 0


def test_fifty_at_once(run):
    ready = []

    def count(event):
        ready.append(event)
        return Shutdown() if len(ready) == 50 else None

    result = run(
        RegisterEventHandler(OnProcessIO(on_stdout=count)),
        *[ExecuteProcess(cmd=["sh", "-c", "echo up; exec sleep 1000"]) for _ in range(50)],
    )
    assert result.code == 0
    assert sum("process has died" in line for line in result.lines) == 50


def test_a_description_can_be_executed(run):
    result = run(ExecuteLocal(process_description=Executable(cmd=["echo"], arguments=["a"]), output="screen"))
    assert result.printed_by("echo") == ["a"]


def test_signals_that_the_parent_ignores_or_blocks_are_heard_by_children(capfd):
    """In a thread, where the launch handles no signals itself."""
    service = LaunchService()
    service.include_launch_description(LaunchDescription([sh("grep -E '^Sig(Blk|Ign)' /proc/self/status")]))
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN), signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        thread = threading.Thread(target=service.run)
        thread.start()
        thread.join(120)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before[1])
        signal.signal(signal.SIGTERM, before[0])
    told = dict(re.findall(r"Sig(Blk|Ign):\s+([0-9a-f]+)", capfd.readouterr().out))
    assert not int(told["Ign"], 16) & 1 << (signal.SIGTERM - 1)
    assert not int(told["Blk"], 16) & 1 << (signal.SIGINT - 1)


def test_descriptors_are_given_back():
    service = LaunchService()
    service.include_launch_description(LaunchDescription([sh("echo x") for _ in range(5)]))
    before = own_descriptors()
    service.run()
    left = [what for _, what in own_descriptors().items() - before.items()]
    assert all(what.endswith("/launch.log") for what in left), left
