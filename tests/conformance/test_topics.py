"""Topics between our tools and the real client, in both directions."""

import signal
import time

import pytest

HI = 'data: "hi"'
STRING = "ignition.msgs.StringMsg"


@pytest.fixture
def ours(stage):
    """A participant of ours that publishes on /chat."""
    participant = stage.participant()
    participant.ask("advertise", "/chat", STRING)
    return participant


def test_the_real_list_shows_our_topics(stage, ours, until):
    ours.ask("advertise", "/another", "gz.msgs.Twist")
    code, out, _ = until(lambda: stage.real_topic("-l"), lambda out: out == "/another\n/chat\n")
    assert (code, out) == (0, "/another\n/chat\n")


def test_both_say_the_same_about_our_publisher(stage, ours, until):
    _, real, _ = until(lambda: stage.real_topic("-i", "-t", "/chat"), lambda out: "tcp" in out)
    code, own, _ = until(lambda: stage.gz("topic", "-i", "-t", "/chat"), lambda out: "tcp" in out)
    assert code == 0
    assert own == real + "No subscribers on topic [/chat]\n"


def test_both_say_the_same_about_a_topic_that_there_is_not(stage):
    real, own = stage.real_topic("-i", "-t", "/nowhere"), stage.gz("topic", "-i", "-t", "/nowhere")
    assert real.wait() == 0
    assert own.wait() == 0
    assert own.out == real.out + "No subscribers on topic [/nowhere]\n"


def test_the_real_echo_shows_what_we_publish(stage, ours):
    echo = stage.real_topic("-e", "-t", "/chat", "-n", "2")
    assert ours.ask("wait", "/chat")
    messages = [(b"\n\x00" + b"\x12\x02hi").hex(), b"\x12\x03you".hex()]
    ours.ask("publish", "/chat", messages=messages)
    assert echo.wait() == 0
    assert echo.out == 'header {\n}\ndata: "hi"\n\ndata: "you"\n\n'


def test_our_publish_reaches_every_real_echo_the_first_time(stage):
    echoes = [stage.real_topic("-e", "-t", "/chat", "-n", "1") for _ in range(3)]
    ready = stage.participant()
    ready.ask("advertise", "/chat", STRING)
    assert ready.ask("wait", "/chat")
    published = stage.gz("topic", "-t", "/chat", "-m", STRING, "-p", HI)
    assert published.wait() == 0, published.error
    # Having printed its message, version 11 of the real client sometimes ends with a segmentation fault of its own.
    assert {echo.wait() for echo in echoes} <= {0, -signal.SIGSEGV}
    assert {echo.out for echo in echoes} == {HI + "\n\n"}


def test_our_echo_shows_what_the_real_client_publishes(stage):
    echo = stage.gz("topic", "-e", "-t", "/chat", "-n", "1")
    deadline = time.monotonic() + 120
    while not echo.out and time.monotonic() < deadline:  # the real one loses some of its messages
        assert stage.real_topic("-t", "/chat", "-m", STRING, "-p", HI).wait() == 0
    assert echo.wait() == 0
    assert echo.out == HI + "\n\n"


def test_our_typed_subscription_hears_the_real_client(stage):
    participant = stage.participant()
    participant.ask("subscribe", "/chat", "gz.msgs.StringMsg")
    deadline = time.monotonic() + 120
    while participant.heard.empty() and time.monotonic() < deadline:
        assert stage.real_topic("-t", "/chat", "-m", STRING, "-p", HI).wait() == 0
    name, _, data = participant.heard.get(timeout=1)
    assert (name, bytes.fromhex(data)) == ("/chat", b"\x12\x02hi")


def test_we_list_a_real_publisher_while_it_is_there(stage):
    participant = stage.participant()
    assert participant.ask("topics") == []
    real = stage.real_topic("-t", "/real", "-m", STRING, "-p", HI)
    found = []
    while not found and real.process.poll() is None:
        found = participant.ask("publishers", "/real")
    assert [kind for _, kind in found] == [STRING]
    assert real.wait() == 0
    deadline = time.monotonic() + 120
    while participant.ask("topics") and time.monotonic() < deadline:
        pass
    assert participant.ask("topics") == []


def test_partitions_are_apart(stage, ours, until):
    stage.environment |= {"GZ_PARTITION": "elsewhere", "IGN_PARTITION": "elsewhere"}
    stranger = stage.participant()
    stranger.ask("advertise", "/elsewhere", STRING)
    _, out, _ = until(lambda: stage.real_topic("-l"), lambda out: "/elsewhere" in out)
    assert out == "/elsewhere\n"
    _, out, _ = until(lambda: stage.gz("topic", "-l"), lambda out: "/elsewhere" in out)
    assert out == "/elsewhere\n"
