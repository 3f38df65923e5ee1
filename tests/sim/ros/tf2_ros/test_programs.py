"""The programs of `ros2 run tf2_ros`: what they publish and print, and how they end."""

import signal
import threading
import time

import pytest

from gz_course.tests.sim.ros.tf2_py.transforms import stamped

ECHO = "gz_course.sim.ros.tf2_ros.tf2_echo"
STATIC = "gz_course.sim.ros.tf2_ros.static_transform_publisher"
MONITOR = "gz_course.sim.ros.tf2_ros.tf2_monitor"
VIEW = "gz_course.sim.ros.tf2_ros.view_frames"


def test_one_publishes_and_the_other_echoes(programs):
    words = ["--x", "1.5", "--yaw", "1.5707963267948966", "--frame-id", "map", "--child-frame-id", "odom"]
    echo = programs.ros2("run", "tf2_ros", "tf2_echo", "map", "odom", "20")
    echo.wait_for(
        'Waiting for transform map ->  odom: Invalid frame ID "map" passed to canTransform argument target_frame'
    )
    publisher = programs.ros2("run", "tf2_ros", "static_transform_publisher", *words)
    echo.wait_for("- Matrix:")
    echo.wait_for("0.000  0.000  0.000  1.000")
    publisher.wait_for("from 'map' to 'odom'")
    assert (echo.stop(), publisher.stop(signal.SIGTERM)) == (0, 0)
    assert (
        "At time 0.0\n"
        "- Translation: [1.500, 0.000, 0.000]\n"
        "- Rotation: in Quaternion [0.000, 0.000, 0.707, 0.707]\n"
        "- Rotation: in RPY (radian) [0.000, -0.000, 1.571]\n"
        "- Rotation: in RPY (degree) [0.000, -0.000, 90.000]\n"
        "- Matrix:\n"
        "  0.000 -1.000  0.000  1.500\n"
        "  1.000  0.000  0.000  0.000\n"
        " -0.000  0.000  1.000  0.000\n"
        "  0.000  0.000  0.000  1.000\n"
    ).replace(" -0.000", "  0.000") in echo.said.replace(" -0.000", "  0.000")
    assert "translation: ('1.500000', '0.000000', '0.000000')" in publisher.said


@pytest.mark.parametrize(
    ("words", "translation", "rotation"),
    [
        ("--frame-id a --child-frame-id b", (0, 0, 0), (0, 0, 0, 1)),
        ("--y -2 --qz 1 --qw 0 --frame-id a --child-frame-id b", (0, -2, 0), (0, 0, 1, 0)),
        ("1 2 3 0 0 3.141592653589793 a b", (1, 2, 3), (1, 0, 0, 0)),
        ("1 2 3 0 0.5 0 -0.5 a b", (1, 2, 3), (0, 0.5, 0, -0.5)),
    ],
)
def test_arguments_of_static_transform_publisher(words, translation, rotation):
    from gz_course.sim.ros.tf2_ros.static_transform_publisher import StaticTransform

    given = StaticTransform(words.split())
    assert given.translation == translation
    assert given.rotation == pytest.approx(rotation)
    assert (given.frame_id, given.child_frame_id) == ("a", "b")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("", "Frame id must not be empty"),
        ("--frame-id a", "Child frame id must not be empty"),
        ("--frame-id a --child-frame-id a", "cannot publish static transform from 'a' to 'a', exiting"),
        ("--frame-id", "Not enough arguments for --frame-id"),
        ("--x one --frame-id a --child-frame-id b", "Failed to parse x argument as float: one"),
        ("--x nan --frame-id a --child-frame-id b", "x must be a finite number, not nan"),
        ("--yaw 1 --qw 1 --frame-id a --child-frame-id b", "Cannot specify both quaternion and Euler rotations"),
        ("--qw 0 --frame-id a --child-frame-id b", "the quaternion 0 0 0 0 is no rotation"),
        ("--x 1 1 2 3 0 0 0 a b", "Cannot specify both new-style (flags) and old-style (arguments)"),
        ("--frame_id a --child-frame-id b", "--frame_id a; did you mean '--frame-id'?"),
        ("1 2 3 a b", "Extra unparsed arguments on command-line: 1 2 3 a b"),
    ],
)
def test_arguments_that_make_no_sense(words, sentence):
    from gz_course.sim.ros.ros_program.errors import Failure
    from gz_course.sim.ros.tf2_ros.static_transform_publisher import StaticTransform

    with pytest.raises(Failure) as caught:
        StaticTransform(words.split())
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("module", "words", "code", "sentence"),
    [
        (STATIC, ["1", "2"], 1, "error parsing command line arguments: Extra unparsed arguments on command-line: 1 2"),
        (ECHO, ["map"], 1, "Usage: tf2_echo source_frame target_frame [echo_rate]"),
        (ECHO, ["a", "b", "often"], 2, "Failed to convert rate argument 'often' to a floating-point number"),
        (ECHO, ["a", "b", "0"], 2, "the rate must be more than 0 Hz, not 0"),
        (MONITOR, ["map"], 1, "TF_Monitor: usage: tf2_monitor framea frameb"),
        (VIEW, ["--wait-time", "soon"], 2, "view_frames: argument --wait-time/-t: invalid float value: 'soon'"),
        (VIEW, ["-t", "-1"], 2, "--wait-time must be 0 or more seconds, not -1.0"),
        (VIEW, ["-t", "0", "-o", "nowhere/tree"], 1, "nowhere/tree.gv cannot be written: No such file or directory"),
    ],
)
def test_exit_codes_and_sentences(call, module, words, code, sentence):
    ended, said = call(module, *words)
    assert ended == code and sentence in said, said


@pytest.fixture
def ctrl_c():
    """Send this process SIGINT once it waits for it, as the terminal does for a program that runs here."""
    made = []

    def after(condition):
        def watch():
            end = time.monotonic() + 120.0
            while not condition() and time.monotonic() < end:
                pause.wait(0.02)
            # Blocked in the main thread by the program, and fetched there.
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

        pause = threading.Event()
        made.append(threading.Thread(target=watch))
        made[-1].start()

    yield after
    for thread in made:
        thread.join(120.0)


def test_ctrl_c_ends_each_with_exit_code_0(call, ctrl_c, ros_node):
    names = {name: f"ended_{number}" for number, name in enumerate((ECHO, MONITOR, VIEW))}
    for module, words, sentence in (
        (ECHO, ["here", "there", "100"], ""),
        (MONITOR, ["here", "there"], "Waiting for transform chain to become available between here and there"),
        (VIEW, ["-t", "1000"], "Listening to tf data for 1000.0 seconds..."),
    ):
        ctrl_c(lambda name=names[module]: name in ros_node.get_node_names())
        code, said = call(module, *words, "--ros-args", "-r", f"__node:={names[module]}")
        assert code == 0 and sentence in said, said


def test_the_tree_of_all_frames(call, programs, ros_node, monkeypatch):
    from gz_course.sim.ros.tf2_ros import StaticTransformBroadcaster

    StaticTransformBroadcaster(ros_node).sendTransform([stamped("map", "odom"), stamped("odom", 'the "base"')])
    monkeypatch.setenv("PATH", "/nowhere")
    text = ""
    for seconds in (0.5, 5, 60):  # long enough for DDS on any machine
        if "map" not in text:
            code, said = call(VIEW, "-t", str(seconds), "-o", "tree")
            assert code == 0, said
            assert "tree.gv is written, but no tree.pdf: Graphviz is not installed, which has the program dot" in said
            text = (programs.folder / "tree.gv").read_text()
    assert '"map" -> "odom"[label=" Broadcaster: default_authority\\nAverage rate: 10000.0' in text
    assert '"odom" -> "the \\"base\\""' in text and '}->"map";' in text
    dot = programs.folder / "bin" / "dot"
    dot.parent.mkdir()
    dot.write_text('#!/bin/sh\necho pdf > "$4"\n')
    dot.chmod(0o755)
    monkeypatch.setenv("PATH", f"{dot.parent}:/bin:/usr/bin")
    code, said = call(VIEW, "-t", "0", "-o", "empty")
    assert (code, "Exporting graph in empty.pdf file..." in said) == (0, True)
    assert (programs.folder / "empty.pdf").read_text() == "pdf\n"
    dot.write_text("#!/bin/sh\necho out of paper >&2\nexit 3\n")
    code, said = call(VIEW, "-t", "0", "-o", "empty")
    assert (code, "dot did not make empty.pdf of empty.gv: out of paper" in said) == (1, True)


def test_the_report_of_tf2_monitor(ros_node, capsys):
    from tf2_msgs.msg import TFMessage

    from gz_course.sim.ros.tf2_ros import Buffer
    from gz_course.sim.ros.tf2_ros.tf2_monitor import Monitor

    buffer = Buffer()
    now = ros_node.get_clock().now().nanoseconds * 1e-9
    moving = stamped("odom", "base", now - 2.0)
    for every, chain in ((True, None), (False, ("map", "base"))):
        monitor = Monitor(ros_node, buffer, chain)
        monitor.look()
        monitor.take_static(TFMessage(transforms=[stamped("map", "odom"), stamped("base", "lidar")]))
        buffer.set_transform_static(stamped("map", "odom"), "me")
        buffer.set_transform(moving, "me")
        monitor.take(TFMessage(transforms=[moving]))
        for _ in range(20):
            monitor.look()
        said = capsys.readouterr().out
        frames = [line.split(",")[0] for line in said.splitlines() if line.startswith("Frame: ")]
        if every:
            assert "RESULTS: for all Frames" in said
            assert frames == ["Frame: base", "Frame: lidar", "Frame: odom"]
        else:
            assert "RESULTS: for map to base\nChain is: map -> odom -> base\nNet delay     avg = " in said
            assert frames == ["Frame: base", "Frame: odom"]
        assert "All Broadcasters:\nNode: <no authority available> " in said
        assert "Frame: odom, published by <no authority available>, Average Delay: 0, Max Delay: 0" in said


def test_names_that_yaml_takes_for_something_else():
    from gz_course.sim.ros.tf2_py import BufferCore
    from gz_course.sim.ros.tf2_ros.view_frames import dot_text, frames_of

    buffer = BufferCore()
    buffer.set_transform_static(stamped("5", "yes"), "me")
    assert '"5" -> "yes"' in dot_text(frames_of(buffer.all_frames_as_yaml()), 1.0)
    assert dot_text(frames_of("[]"), 1.0) == 'digraph G { "No tf data received" }'
