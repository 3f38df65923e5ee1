"""Launch tests of real processes, run as by the command `launch_test`, in this process."""

import sys
import textwrap
import threading
import xml.etree.ElementTree as ET

import pytest

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch_testing import launch_test

HEAD = """
import unittest
import launch
import launch_testing
from launch.actions import DeclareLaunchArgument, ExecuteProcess, RegisterEventHandler
from launch.substitutions import LaunchConfiguration
from launch_testing.actions import ReadyToTest

def sh(script, **options):
    return ExecuteProcess(cmd=["sh", "-c", script], **options)
"""
LOOPS = '''
def generate_test_description():
    """Is ready when the process says so; the tests get the process as an argument."""
    loops = sh("for i in 1 2 3; do echo Loop $i; done; echo '\\033[31moops\\033[0m' >&2; exec sleep 600", name="loops")
    ready = launch_testing.event_handlers.StdoutReadyListener(
        target_action=loops, ready_txt="Loop 3", actions=[ReadyToTest()]
    )
    quiet = sh(["exec sleep ", LaunchConfiguration("time")], name="quiet")
    return launch.LaunchDescription(
        [DeclareLaunchArgument("time", default_value="500"), RegisterEventHandler(ready), loops, quiet]
    ), {"loops": loops}

class TestBeside(unittest.TestCase):
    @classmethod
    def setUpClass(cls, proc_output):
        cls.handler = proc_output

    def test_output(self, proc_output, proc_info, loops):
        assert self.handler is self.proc_output is proc_output
        proc_output.assertWaitFor("Loop 3", process=loops, stream="stdout", timeout=60)
        proc_output.assertWaitFor(["oo", "ps"], process="loops", timeout=60)
        proc_output.assertWaitFor("oops", timeout=60)
        assert not proc_output.waitFor("Loop 4", process=loops, timeout=0.0)
        proc_info.assertWaitForStartup("quiet", timeout=60)
        with self.assertRaisesRegex(AssertionError, "Timed out waiting for process 'quiet' to finish"):
            proc_info.assertWaitForShutdown("quiet", timeout=0.0)
        assert list(proc_output["quiet-2"]) == []

    def test_a_process_of_the_test(self, launch_service, proc_info, proc_output, test_args):
        action = sh("echo here; read never", name="short")
        tools = launch_testing.tools
        with tools.launch_process(launch_service, action, proc_info, proc_output) as short:
            assert short.wait_for_output(lambda text: "here" in text, timeout=60)
            assert short.running and not short.terminated and (short.stdout, short.stderr) == ("here\\n", "")
        assert short.wait_for_shutdown(timeout=60) and short.exit_code == -2
        assert test_args == {"time": "400"}

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_codes(self, proc_info, loops):
        launch_testing.asserts.assertExitCodes(proc_info, [-2])
        launch_testing.asserts.assertExitCodes(proc_info, [-2], process=loops)
        with self.assertRaisesRegex(AssertionError, "Proc loops-1 exited with code -2"):
            launch_testing.asserts.assertExitCodes(proc_info, process=loops)
        assert [event.action.process_details["name"] for event in proc_info] == ["loops-1", "quiet-2", "short-3"]
        assert proc_info["quiet"].cmd == ["sh", "-c", "exec sleep 400"]

    def test_order(self, proc_output, loops):
        with launch_testing.asserts.assertSequentialStdout(proc_output, loops) as order:
            order.assertInStdout("Loop 1")
            order.assertInStdout("Loop 3")
            with self.assertRaisesRegex(AssertionError, "'Loop 2' not found in sequence(.|\\n)*Loop 3"):
                order.assertInStdout("Loop 2")
        launch_testing.asserts.assertInStderr(proc_output, "oops", loops)
'''


@pytest.fixture(autouse=True)
def log_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    launch_logging.reset()
    yield
    launch_logging.reset()


@pytest.fixture
def run(tmp_path, capfd):
    """Run a launch test with this content; return exit code, stdout and stderr."""

    def run(content, *arguments):
        file = tmp_path / f"file_{len(list(tmp_path.iterdir()))}_launch_test.py"
        file.write_text(HEAD + textwrap.dedent(content))
        launch_logging.reset()
        try:
            code = launch_test.main([str(file), *arguments])
        except SystemExit as end:
            code = end.code
        return code, *capfd.readouterr()

    return run


def test_tests_beside_processes_and_after_their_end(run, tmp_path):
    report = tmp_path / "report.xml"
    code, out, err = run(LOOPS, "time:=400", "--junit-xml", str(report), "--package-name", "pack")
    assert code == 0, out + err
    assert "test_order (pack.TestAfter.test_order) ... ok" in err and "Ran 2 tests" in err
    suites = ET.parse(report).getroot()
    assert suites.get("tests") == "4" and suites.get("failures") == suites.get("errors") == "0"
    assert [case.get("name") for case in suites.iter("testcase")] == [
        "test_a_process_of_the_test", "test_output", "test_codes", "test_order",
    ]  # fmt: skip

    code, out, _ = run(LOOPS, "-s")
    shown = ["    'time':", "        no description given", "        (default: '500')"]
    assert (code, out.splitlines()[2:]) == (0, shown)


def test_every_argument_of_parametrize_is_a_launch(run):
    code, out, err = run(
        """
        @launch_testing.parametrize("word, number", [("a", 1), ("b", 2)])
        @launch_testing.markers.keep_alive
        def generate_test_description(word, number):
            if number > 2:
                raise unittest.SkipTest("too much")
            return launch.LaunchDescription([sh(f"echo {word}"), ReadyToTest()])

        class TestIt(unittest.TestCase):
            def test_it(self, proc_output, proc_info, word, number):
                proc_info.assertWaitForShutdown("sh", timeout=60)
                launch_testing.asserts.assertInStdout(proc_output, word, None)
                assert number == 1
        """
    )
    assert code == 1 and "Starting test run" in out
    assert "TestIt.test_it[a, 1]) ... ok" in err and "TestIt.test_it[b, 2]) ... FAIL" in err


@pytest.mark.parametrize(
    "content, code, said",
    [
        ("generate_test_description = lambda: launch.LaunchDescription([sh('true')])\n", 2, "containing a ReadyToTest"),
        ("x = 1\n", 2, "it defines no generate_test_description()"),
        ("raise ValueError('broken')\n", 2, "ValueError: broken"),
        (
            "@launch_testing.parametrize('other', [1])\ndef generate_test_description(): pass\n",
            2,
            "matching parametrized argument 'other'",
        ),
        (
            "def generate_test_description(ready):\n    return launch.LaunchDescription([])\n",
            2,
            "unexpected extra argument 'ready'",
        ),
        (
            "def generate_test_description():\n    raise unittest.SkipTest('not today')\n",
            0,
            "is skipped: not today",
        ),
        (
            "@launch_testing.ready_to_test_action_timeout(0.01)\ndef generate_test_description():\n"
            "    late = launch.actions.TimerAction(period=600.0, actions=[ReadyToTest()])\n"
            "    return launch.LaunchDescription([late])\n",
            1,
            "Timed out waiting for processes to start up",
        ),
    ],
)
def test_what_is_wrong_is_said(run, content, code, said):
    ended, out, err = run(content)
    assert (ended, said in out + err) == (code, True), out + err
    assert "Traceback" not in err


def test_processes_that_end_too_early(run):
    code, out, _ = run(
        """
        import threading
        def generate_test_description():
            return launch.LaunchDescription([sh("echo ouch; exit 3", name="bad"), ReadyToTest()])

        class TestLate(unittest.TestCase):
            end = threading.Event()

            def test_late(self):
                self.end.wait()
        """,
        "--package-name",
        "too_early",
    )
    (thread,) = (thread for thread in threading.enumerate() if thread.name == "launch_test")
    sys.modules.pop("too_early").TestLate.end.set()
    thread.join()
    assert code == 1 and "Process 'bad-1' exited with 3\n##### 'bad-1' output #####\nouch\n" in out


def test_a_file_that_is_not_there(capsys, tmp_path):
    (tmp_path / "robot_launch_test.py").touch()
    with pytest.raises(SystemExit):
        launch_test.main([str(tmp_path / "robt_launch_test.py")])
    assert "does not exist; did you mean 'robot_launch_test.py'?" in capsys.readouterr().err
