"""Messages as text, and their definitions: ours against those of the real client, for every type both know."""

import time

import pytest
from hypothesis import HealthCheck, Phase, given, settings, strategies

from gz.msgs import message_class, type_names
from gz.msgs.descriptor_text import describe
from gz.msgs.text import from_text, to_text
from tests.conformance.random_messages import Vocabulary

OURS = [name.replace("gz.", "ignition.") for name in type_names()]
NEWER = {
    *("ignition.msgs.Dataframe", "ignition.msgs.EntityWrench", "ignition.msgs.MaterialColor"),
    *(f"ignition.msgs.{name}WithCovariance" for name in ("Odometry", "Pose", "Twist")),
}
"""Types that came after the release of the real client."""
AT_ONCE = 12


@pytest.fixture(scope="session")
def information(library):
    return library.information(sorted(set(OURS) & set(library.names())))


@pytest.fixture(scope="session")
def vocabulary(information):
    return Vocabulary(information)


def test_the_real_client_knows_our_types(information):
    assert set(OURS) - set(information) == NEWER


def newer_lines(own, real):
    """The lines of our definition that the real one does not have, and the other way round."""
    return set(own.splitlines()) - set(real.splitlines()), set(real.splitlines()) - set(own.splitlines())


@pytest.mark.parametrize("name", [name for name in OURS if name not in NEWER])
def test_the_definition_is_that_of_the_real_client(information, name):
    own = describe(message_class(name)).replace("gz.msgs", "ignition.msgs").replace("gz/msgs", "ignition/msgs")
    if own != information[name]:
        # One of the two has fields that the other lacks; what both have must still be written alike.
        ours, real = newer_lines(own, information[name])
        own_fields = {line.split(" = ")[0] for line in ours}
        assert not own_fields & {line.split(" = ")[0] for line in real}


@pytest.fixture(scope="module")
def echoes(shared_stage):
    """Type name -> (publishing participant, real echo that listens to it), started when first asked for."""
    participant, started = shared_stage.participant(), {}

    def echo(name):
        if name not in started:
            topic = f"/{name}"
            participant.ask("advertise", topic, name)
            started[name] = shared_stage.real_topic("-e", "-t", topic)
            assert participant.ask("wait", topic)
        return participant, started[name]

    return echo


@pytest.mark.parametrize("name", [name for name in OURS if name not in NEWER])
@settings(max_examples=8, deadline=None, phases=[Phase.explicit, Phase.generate, Phase.shrink])
@given(data=strategies.data())
def test_the_real_echo_prints_what_we_print(vocabulary, echoes, name, data):
    messages = data.draw(strategies.lists(vocabulary.messages(message_class(name)), min_size=1, max_size=4))
    participant, echo = echoes(name)
    wanted = "".join(to_text(message) + "\n" for message in messages)
    assert [to_text(from_text(to_text(each), message_class(name))) for each in messages] == list(map(to_text, messages))
    wire = [message.SerializeToString().hex() for message in messages]
    participant.ask("publish", f"/{name}", messages=wire)
    assert echo.take(len(wanted)) == wanted


@settings(
    max_examples=1,
    deadline=None,
    phases=[Phase.generate],
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(data=strategies.data())
def test_our_echo_prints_what_the_real_client_publishes(stage, vocabulary, data):
    """Text -> real publisher -> our echo: the same text again, for every type."""
    left = {name: data.draw(vocabulary.messages(message_class(name), 1)) for name in OURS if name not in NEWER}
    participant = stage.participant()
    for name in left:
        participant.ask("subscribe", f"/{name}")
    deadline = time.monotonic() + 60
    while left and time.monotonic() < deadline:  # the real one loses some of its messages
        some = list(left)[:AT_ONCE]
        programs = [stage.real_topic("-t", f"/{name}", "-m", name, "-p", to_text(left[name]) or " ") for name in some]
        assert [program.wait() for program in programs] == [0] * len(some)
        while not participant.heard.empty():
            topic, kind, wire = participant.heard.get()
            assert topic == f"/{kind}"
            if kind in left:
                assert to_text(message_class(kind).FromString(bytes.fromhex(wire))) == to_text(left.pop(kind))
    assert list(left) == []
