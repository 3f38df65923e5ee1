import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.transport import Node
from gz_course.sim.gz.transport.commands import topic as command

TWIST = ("-m", "gz.msgs.Twist", "-p", "linear: {x: 0.5}, angular: {z: -1e-3}")


@pytest.fixture
def node(partition):
    with Node() as each:
        yield each


@pytest.fixture
def cmd_vel(node):
    return node.advertise("/cmd_vel", Twist)


def heard_by(publisher):
    assert publisher.wait_for_subscribers(timeout=120)


def test_list_names_what_is_published_then_what_is_only_wanted(gz, node, cmd_vel):
    node.advertise("/b", StringMsg)
    node.subscribe(Odometry, "/a_wanted", print)
    node.subscribe(Twist, "/cmd_vel", print)
    assert gz("topic", "-l").end() == (0, "/b\n/cmd_vel\n/a_wanted\n", "")


def test_list_is_empty_and_well_when_there_is_nothing(gz):
    assert gz("topic", "--list").end() == (0, "", "")


def test_info_names_addresses_and_types(gz, node, cmd_vel):
    address = node.topic_info("/cmd_vel")[0][0].addr
    node.subscribe_raw("/cmd_vel", print)
    code, out, error = gz("topic", "-i", "-t", "/cmd_vel").end()
    assert (code, error) == (0, "")
    assert out == (
        f"Publishers [Address, Message Type]:\n  {address}, gz.msgs.Twist\n"
        f"Subscribers [Address, Message Type]:\n  {address}, google.protobuf.Message\n"
    )


def test_info_on_an_unknown_topic_names_the_nearest(gz, cmd_vel):
    code, out, error = gz("topic", "-i", "-t", "/cmd_vle").end()
    assert code == 0
    assert out == "No publishers on topic [/cmd_vle]\nNo subscribers on topic [/cmd_vle]\n"
    assert error == "gz topic: there is no topic [/cmd_vle]; did you mean '/cmd_vel'?\n"


def test_echo_prints_text_and_an_empty_line_and_ends_after_n(gz, cmd_vel):
    echo = gz("topic", "-e", "-t", "/cmd_vel", "-n", "2")
    heard_by(cmd_vel)
    message = Twist()
    cmd_vel.publish(message)
    message.linear.x = 1
    cmd_vel.publish(message)
    assert echo.end() == (0, "\nlinear {\n  x: 1\n}\n\n", "")


def test_echo_in_json_is_one_line_a_message(gz, cmd_vel):
    echo = gz("topic", "-e", "-t", "/cmd_vel", "--json-output", "-n", "1")
    heard_by(cmd_vel)
    message = Twist()
    message.linear.x, message.angular.z = 2, float("-inf")
    cmd_vel.publish(message)
    assert echo.end() == (0, '{"linear":{"x":2},"angular":{"z":"-Infinity"}}\n', "")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("verb", ["-e", "-f"])
def test_signals_end_well_and_lines_come_at_once(gz, cmd_vel, verb, number):
    echo = gz("topic", verb, "-t", "/cmd_vel")
    heard_by(cmd_vel)
    for _ in range(12):
        cmd_vel.publish(Twist())
    assert echo.line() == "\n"  # although it is a pipe and the program continues
    echo.signal(number)
    code, _, error = echo.end()
    assert (code, error) == (0, "")


def test_echo_after_a_duration_ends_well_when_the_topic_was_silent(gz, cmd_vel):
    assert gz("topic", "-e", "-t", "/cmd_vel", "-d", "0.2").end() == (0, "", "")


def test_echo_of_a_topic_nobody_publishes_says_so_and_waits(gz, node, cmd_vel):
    echo = gz("topic", "-e", "-t", "/cmd_val", "-n", "1")
    assert echo.line("error") == (
        "gz topic: still waiting for somebody who publishes on [/cmd_val]; did you mean '/cmd_vel'?\n"
    )
    late = node.advertise("/cmd_val", StringMsg)
    heard_by(late)
    late.publish(StringMsg(data="at last"))
    assert echo.end() == (0, 'data: "at last"\n\n', "")


def test_echo_of_a_topic_nobody_published_says_so_at_the_end_of_its_duration(gz):
    code, _, error = gz("topic", "-e", "-t", "/nowhere", "-d", "0.1").end()
    assert code == 0
    assert "nobody published on [/nowhere]" in error


def test_echo_of_a_type_that_is_not_known_says_which(gz, node):
    strange = node.advertise("/strange", "gz.msgs.Twizt")
    echo = gz("topic", "-e", "-t", "/strange")
    heard_by(strange)
    strange.publish_raw(b"", "gz.msgs.Twizt")
    code, out, error = echo.end()
    assert (code, out) == (1, "")
    assert "'gz.msgs.Twizt'" in error
    assert "did you mean 'gz.msgs.Twist" in error


def test_broken_bytes_are_reported_and_do_not_end_the_echo(gz, node):
    odd = node.advertise("/odd", "gz.msgs.StringMsg")
    echo = gz("topic", "-e", "-t", "/odd", "-n", "1")
    heard_by(odd)
    odd.publish_raw(b"\xff\xff", "gz.msgs.StringMsg")
    odd.publish_raw(StringMsg(data="fine").SerializeToString(), "gz.msgs.StringMsg")
    code, out, error = echo.end()
    assert (code, out) == (0, 'data: "fine"\n\n')
    assert error == "gz topic: a message on [/odd] is no gz.msgs.StringMsg; it is left out.\n"


@pytest.mark.parametrize("more_comes", [True, False])
def test_a_reader_that_leaves_ends_the_echo_quietly(cmd_vel, more_comes):
    gz = Path(sys.executable).with_name("gz")
    read, write = os.pipe()
    with subprocess.Popen([gz, "topic", "-e", "-t", "/cmd_vel"], stdout=write, stderr=subprocess.PIPE) as echo:
        try:
            os.close(write)
            heard_by(cmd_vel)
            cmd_vel.publish(Twist())
            assert os.read(read, 1) == b"\n"
            os.close(read)
            if more_comes:
                cmd_vel.publish(Twist())
            assert echo.wait(120) == 0
            assert echo.stderr.read() == b""
        finally:
            echo.kill()


def test_frequency_prints_intervals_and_their_statistics(capsys):
    times = [0, *(100_000_000 + 10_000_000 * each for each in range(10))]
    command._print_frequency(times)
    lines = capsys.readouterr().out.splitlines()
    assert lines[:3] == ["", "", "interval [0]:    0.1s"]
    assert lines[3:12] == [f"interval [{each}]:    0.01s" for each in range(1, 10)]
    assert lines[12:] == ["average rate: 52.6316", "min: 0.01s max: 0.1s std dev: 0.027s window: 10"]


def test_frequency_uses_eleven_arrivals_and_prints_at_the_twelfth(gz, cmd_vel):
    measure = gz("topic", "-f", "-t", "/cmd_vel")
    heard_by(cmd_vel)
    for _ in range(24):
        cmd_vel.publish(Twist())
    seen = [measure.line() for _ in range(28)]
    assert [line.partition(":")[0] for line in seen].count("average rate") == 2
    assert sum(line.startswith("interval [") for line in seen) == 20


def test_what_is_published_arrives_in_every_process_the_first_time(gz, node, inbox, start_peer):
    peers = [start_peer() for _ in range(3)]
    for peer in peers:
        peer.ask("subscribe", topic="/chat")
    node.subscribe(StringMsg, "/chat", inbox)
    done = gz("topic", "-t", "/chat", "-m", "gz.msgs.StringMsg", "-p", 'data: "hello"')
    assert done.end() == (0, "", "")
    assert inbox.take() == [StringMsg(data="hello")]
    assert [peer.heard() for peer in peers] == [[("/chat", "hello")]] * 3


@pytest.mark.parametrize(
    "spelling", ["gz.msgs.Twist", "gz_msgs.Twist", ".gz.msgs.Twist", "Twist", "ignition.msgs.Twist"]
)
def test_every_spelling_of_a_type_can_be_published(gz, node, inbox, spelling):
    node.subscribe(Twist, "/cmd_vel", inbox)
    assert gz("topic", "-t", "/cmd_vel", "-m", spelling, *TWIST[2:]).end() == (0, "", "")
    (message,) = inbox.take()
    assert (message.linear.x, message.angular.z) == (0.5, -1e-3)


def test_a_large_message_is_out_before_the_program_ends(gz, node, inbox):
    node.subscribe(StringMsg, "/large", inbox)
    text = "x" * 100_000
    assert gz("topic", "-t", "/large", "-m", "gz.msgs.StringMsg", "-p", f'data: "{text}"').end()[0] == 0
    assert inbox.take() == [StringMsg(data=text)]


def test_publishing_where_nobody_listens_says_so(gz, node):
    node.subscribe(Twist, "/cmd_vel", print)
    code, out, error = gz("topic", "-t", "/cmd_val", *TWIST).end()
    assert (code, out) == (1, "")
    assert error == "gz topic: nobody listens on [/cmd_val], so the message is lost; did you mean '/cmd_vel'?\n"


def test_publishing_another_type_than_wanted_says_so(gz, node):
    node.subscribe(StringMsg, "/cmd_vel", print)
    code, out, error = gz("topic", "-t", "/cmd_vel", *TWIST).end()
    assert (code, out) == (1, "")
    assert error == (
        "gz topic: the subscribers of [/cmd_vel] take gz.msgs.StringMsg, so nobody received the gz.msgs.Twist.\n"
    )


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["-e"], 107, "--echo requires --topic"),
        (["-i"], 107, "--info requires --topic"),
        (["-f"], 107, "--frequency requires --topic"),
        (["-p", "", "-t", "/a"], 107, "--pub requires --msgtype"),
        (["-p", "", "-m", "gz.msgs.Twist"], 107, "--pub requires --topic"),
        (["-l", "--json-output"], 107, "--json-output requires --echo"),
        (["-e", "-t", "/a", "-n", "1", "-d", "1"], 108, "--duration excludes --num"),
        (["-l", "-e", "-t", "/a"], 108, "--list excludes --echo"),
        (["--eco"], 109, "did you mean '--echo'?"),
        (["-l", "/scan"], 109, "'/scan' belongs to no option"),
        (["-e", "-t", "/a", "-n", "many"], 104, "'many'"),
        (["-e", "-t", "/a", "-d", "-1"], 104, "'-1'"),
        (["-e", "-t", "/a", "-d", "nan"], 104, "'nan'"),
        (["-e", "-t"], 114, "-t/--topic"),
        (["-e", "-t", "/a b"], 1, "must not contain a space"),
        (["-e", "-t", ""], 1, "must not be empty"),
        (["-p", "", "-t", "/a", "-m", "gz.msgs.Twits"], 1, "did you mean 'gz.msgs.Twist"),
        (["-p", "linaer: {}", "-t", "/a", "-m", "gz.msgs.Twist"], 1, "did you mean 'linear'?"),
        (["-p", "linear: {x: fast}", "-t", "/a", "-m", "gz.msgs.Twist"], 1, "line 1, column 13"),
    ],
)
def test_wrong_usage_is_one_line_and_a_code(capsys, arguments, code, words):
    from gz_course.sim.gz.command import main

    try:
        result = main(["topic", *arguments])
    except SystemExit as end:
        result = end.code
    out, error = capsys.readouterr()
    assert (result, out, error.count("\n")) == (code, "", 1)
    assert error.startswith("gz topic: ")
    assert words in error


@pytest.mark.parametrize("arguments", [[], ["-h"], ["-t", "/a"]])
def test_without_a_command_there_is_help(capsys, arguments):
    from gz_course.sim.gz.command import main

    with pytest.raises(SystemExit) as end:
        main(["topic", *arguments])
    assert not end.value.code
    assert "--json-output" in capsys.readouterr().out


def test_nothing_heavy_is_loaded():
    program = "import sys, gz.transport.commands.topic; print(int('mujoco' in sys.modules or 'numpy' in sys.modules))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=True)
    assert done.stdout == "0\n"
