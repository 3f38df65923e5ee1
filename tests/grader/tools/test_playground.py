"""The playground starts real processes in a fence of its own and leaves nothing behind, however it ends."""

import contextlib
import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.tools import live_frame, playground
from gz_course.grader.tools.playground import Playground
from gz_course.tests.eventually import within

DEADLINE = 120.0
eventually = within(DEADLINE)
FENCE = ("ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE", "GZ_PARTITION", "ROS_LOG_DIR")


@pytest.fixture
def room():
    with Playground() as opened:
        yield opened


def gone(pid):
    try:
        return psutil.Process(pid).status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


def start_script(room, tmp_path, text):
    """Start a Python script that prints `up` when it is ready."""
    script = tmp_path / "script.py"
    script.write_text(textwrap.dedent(text))
    program = room.start(f"python '{script}'")
    eventually(lambda: "up" in program.output, "the script runs")
    return program


def test_programs_and_nodes_of_this_process_share_one_fence(room, tmp_path):
    program = start_script(room, tmp_path, f"import os; print([os.environ[n] for n in {FENCE}], 'up')")
    assert [os.environ[name] for name in FENCE] == [
        str(room.domain),
        "LOCALHOST",
        room.partition,
        room.environment["ROS_LOG_DIR"],
    ]
    assert str([os.environ[name] for name in FENCE]) in program.output


def test_a_new_playground_closes_the_one_before_it(room):
    program = room.start("sleep 1000")
    with Playground() as other:
        assert gone(program.pid) and "closed" in repr(room)
        room.close()  # once more does no harm to the new one
        assert os.environ["GZ_PARTITION"] == other.partition
    assert os.environ.get("GZ_PARTITION") != other.partition


def test_a_command_started_again_ends_its_first_run(room):
    first, other = room.start("sleep 1000"), room.start("sleep 999")
    second = room.start("sleep 1000")
    assert gone(first.pid) and room.running == [other, second]
    third = room.start("sleep 998", instead_of="sleep")
    assert room.running == [third]


def test_it_lists_what_runs(room):
    assert "nothing" in repr(room) and str(room.domain) in repr(room)
    program = room.start("sleep 1000")
    assert f"process {program.pid}  sleep 1000" in repr(room)
    program.stop()
    assert "sleep" not in repr(room)


def test_waiting_for_what_a_program_prints(room, tmp_path, monkeypatch):
    monkeypatch.setattr(playground, "crowded", lambda: False)
    program = start_script(room, tmp_path, "print('ready: 3 bridges'); print('up'); import signal; signal.pause()")
    assert program.wait_for("ready") == "ready: 3 bridges\nup\n"
    with pytest.raises(
        TimeoutError,
        match=r"within 0.1 s, not printed 'never' \(it runs, and has had \d+\.\d s of processor time\), but:\nready",
    ):
        program.wait_for("never", deadline=0.1)


def test_on_a_crowded_machine_one_waits_longer(room, tmp_path, monkeypatch):
    program = start_script(room, tmp_path, "print('up', flush=True); import signal; signal.pause()")
    asked = iter([True, True, False])
    monkeypatch.setattr(playground, "crowded", lambda: next(asked))
    with pytest.raises(TimeoutError, match=r"within 0\.6 s, not printed 'never'"):
        program.wait_for("never", deadline=0.2)


def test_who_has_ended_is_not_waited_for(room, tmp_path):
    program = start_script(room, tmp_path, "print('up, and out')")
    with pytest.raises(TimeoutError, match="has ended and not printed 'more', but:\nup, and out"):
        program.wait_for("more")
    assert "out" in program.wait_for("out")


@pytest.mark.parametrize("before", ["/usr/bin", "/usr/bin:{here}", "{here}:/usr/bin"])
def test_the_commands_of_the_course_are_first_on_the_path_and_stay_there(monkeypatch, before):
    here = str(Path(sys.executable).parent)
    monkeypatch.setenv("PATH", before.format(here=here))
    with Playground():
        pass
    assert os.environ["PATH"] == f"{here}:/usr/bin"


def test_closing_gives_environment_and_folder_back(monkeypatch):
    monkeypatch.setenv("GZ_PARTITION", "mine")
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    with Playground() as room:
        folder = Path(room.environment["ROS_LOG_DIR"]).parent
        assert folder.is_dir()
    assert os.environ["GZ_PARTITION"] == "mine"
    assert "ROS_DOMAIN_ID" not in os.environ
    assert not folder.exists()


def test_stop_is_a_ctrl_c_and_the_output_stays(room, tmp_path):
    program = start_script(
        room,
        tmp_path,
        """
        import signal, sys
        print("up", flush=True)
        try:
            signal.pause()
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            sys.exit(7)
        """,
    )
    assert program.exit_code is None
    assert program.stop() == 7
    room.close()
    assert program.output == "up\ninterrupted\n"
    assert "ended with exit code 7" in room.report()


def test_ctrl_c_works_where_this_process_ignores_it(room, tmp_path):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)  # as a notebook's kernel does between two cells
    try:
        program = start_script(room, tmp_path, "import signal; print('up', flush=True); signal.pause()")
    finally:
        signal.signal(signal.SIGINT, before)
    program.stop()
    assert "KeyboardInterrupt" in program.output


def test_who_does_not_listen_is_ended_with_all_it_started(room, tmp_path, monkeypatch):
    monkeypatch.setattr(playground, "GRACE", 0.1)
    program = start_script(
        room,
        tmp_path,
        """
        import signal, subprocess, sys
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        child = subprocess.Popen([sys.executable, "-I", "-S", "-c", "import signal; signal.pause()"])
        print(child.pid, "up", flush=True)
        while True:
            signal.pause()
        """,
    )
    child = int(program.output.split()[0])
    room.close()
    assert program.exit_code == -signal.SIGKILL
    eventually(lambda: gone(child), "its child is gone")


OWNER = """
import signal, sys
from gz_course.grader.tools.playground import Playground
room = Playground()
program = room.start("sleep 1000")
print(program.pid, room.environment["ROS_LOG_DIR"], flush=True)
if sys.argv[1] == "wait":
    signal.pause()
"""


def test_programs_end_with_a_process_that_forgot_to_close():
    done = subprocess.run(
        [sys.executable, "-c", OWNER, "leave"], capture_output=True, text=True, timeout=DEADLINE, check=True
    )
    pid, log_dir = done.stdout.split()
    assert gone(int(pid))
    assert not Path(log_dir).parent.exists()


def test_programs_end_with_a_process_that_is_killed(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", OWNER, "wait"],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"TMPDIR": str(tmp_path)},
    ) as owner:
        pid = int(owner.stdout.readline().split()[0])
        # It is `sleep` only after the few milliseconds of its launcher.
        eventually(lambda: psutil.Process(pid).name() == "sleep", "sleep runs")
        owner.kill()
    try:
        eventually(lambda: gone(pid), "the program has ended with its owner")
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def test_an_unknown_command_is_named_with_the_nearest(room):
    with pytest.raises(UsageError, match=r"there is no command 'paramter_bridge'; did you mean 'parameter_bridge'\?"):
        room.start("paramter_bridge --help")


def test_no_command_at_all(room):
    with pytest.raises(UsageError, match="which command"):
        room.start("  ")


def test_a_closed_playground_starts_nothing(room):
    room.close()
    with pytest.raises(UsageError, match="closed"):
        room.start("sleep 1")


def test_a_program_that_fails_says_why(room):
    program = room.start("gz sim lidar_rom.sdf -r -s")
    eventually(lambda: program.exit_code is not None, "gz sim gives up")
    assert program.exit_code == 1
    assert "lidar_rom.sdf" in program.output and "exit code 1" in room.report()


def test_a_view_that_is_missing_or_broken_is_one_sentence(room, monkeypatch):
    def missing(name):
        raise ModuleNotFoundError(name)

    monkeypatch.setattr(live_frame.importlib, "import_module", missing)
    frame = room.show()
    assert frame._repr_mimebundle_() == {"text/plain": repr(frame)} and "no live view" in repr(frame)

    class View:
        address, closed = "http://127.0.0.1:1/<token>/", False

        def __init__(self, world, search):
            assert (world, search) == ("", True)

        def wait(self):
            if not self.address:
                raise ValueError("there is no browser")

        def close(self):
            View.closed = True

    monkeypatch.setattr(
        live_frame.importlib, "import_module", lambda name: SimpleNamespace(View=View, ViewError=ValueError)
    )
    html = room.show()._repr_mimebundle_()["text/html"]
    assert 'src="http://127.0.0.1:1/&lt;token&gt;/"' in html and "live" in html
    panels = []

    class Panel:
        def __init__(self, title, content):
            panels.append(content)

        def close(self):
            panels.clear()

    monkeypatch.setattr(live_frame, "in_jupyterlab", lambda: True)
    monkeypatch.setattr(live_frame, "SidePanel", Panel)
    html = room.show()._repr_mimebundle_()["text/html"]
    assert "<iframe" not in html and "beside the notebook" in html and "&lt;token&gt;" in html
    assert len(panels) == 1 and '<iframe src="http://127.0.0.1:1/&lt;token&gt;/"' in panels[0]
    View.address = ""
    assert "there is no browser" in repr(room.show()) and View.closed and not panels, "the panel is closed, too"


def test_what_ros_says_is_shown_where_the_program_says_so(room, tmp_path, monkeypatch):
    script = tmp_path / "watcher.py"
    script.write_text(
        "import sys, signal; print('open: http://127.0.0.1:9/?url=x'); print('Ctrl-C ends it', flush=True)\n"
        "assert sys.argv[1:] == ['/scan', '/a b']; signal.pause()"
    )
    monkeypatch.setattr(playground, "WATCH", f"{sys.executable} {script}")
    frame = room.watch("/scan", "/a b")
    assert frame.address == "http://127.0.0.1:9/?url=x" and repr(frame) == "What ROS says on /scan, /a b, live."
    script.write_text("print('course: there is no viewer')")
    frame = room.watch()
    assert "there is no viewer" in repr(frame) and not frame.address and room.running == []
    monkeypatch.setenv("COURSE_PROXY", "/")
    frame = room.watch("/scan")
    assert "browser on the machine" in repr(frame) and not frame.address and room.running == []
