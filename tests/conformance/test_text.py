"""Messages as text, and their definitions: ours against those of the real client, for every type both know."""

import time

import pytest
from hypothesis import HealthCheck, Phase, given, settings, strategies

from gz_course.sim.gz.msgs import message_class, type_names
from gz_course.sim.gz.msgs.descriptor_text import describe
from gz_course.sim.gz.msgs.proto_reader import read_proto
from gz_course.sim.gz.msgs.text import from_text, to_text
from gz_course.tests.conformance.random_messages import Vocabulary

OURS = [name.replace("gz.", "ignition.") for name in type_names()]
NEWER = {
    f"ignition.msgs.{name}"
    for name in (
        *("AirSpeed", "AirSpeedSensor", "CameraTrack", "DataLoadPathOptions", "Dataframe"),
        *("DVLBeamState", "DVLKinematicEstimate", "DVLRangeEstimate", "DVLTrackingTarget", "DVLVelocityTracking"),
        *("EntityPlugin_V", "EntityWrench", "EntityWrenchMap", "Lens", "MaterialColor", "WheelSlipParametersCmd"),
        *("Parameter", "ParameterDeclaration", "ParameterDeclarations"),
        *("ParameterError", "ParameterName", "ParameterValue"),
        *("OdometryWithCovariance", "PoseWithCovariance", "TwistWithCovariance"),
    )
}
"""Types that came after the release of the real client."""
BOTH_KNOW = [name for name in OURS if name not in NEWER]
AT_ONCE = 12
pytestmark = pytest.mark.proof  # thousands of messages through the real client


@pytest.fixture(scope="session")
def information(library):
    return library.information(sorted(set(OURS) & set(library.names())))


@pytest.fixture(scope="session")
def vocabulary(information):
    return Vocabulary(information)


def test_both_know_the_same_types(information, library):
    assert set(OURS) - set(information) == NEWER
    assert set(library.names()) - set(OURS) == set()


def numbers(message, scope=""):
    """Of a definition and all that is nested in it: (field, number) -> its type, (enum value, number) -> its enum."""
    name = f"{scope}{message.name}"
    found = {(f"{name}.{field.name}", field.number): kind(field) for field in message.field}
    for enum in message.enum_type:
        found |= {(f"{name}.{enum.name}.{value.name}", value.number): enum.name for value in enum.value}
    for nested in message.nested_type:
        found |= numbers(nested, f"{name}.")
    return found


def kind(field):
    """Label, type, and the last word of the name of a message or enum; the packages differ in spelling only."""
    what = field.type_name.rpartition(".")[2] if field.type_name else field.type
    return field.label, what, field.HasField("oneof_index")


def test_fields_have_the_numbers_and_types_of_the_real_client(information):
    """Whatever the real one has, ours has under the same name, with the same number and type."""
    different = []
    for name in BOTH_KNOW:
        own, real = (
            numbers(read_proto(text.split("\n\n", 1)[1], name).message_type[0])
            for text in (describe(message_class(name)), information[name])
        )
        different += [f"{name}: {entry} {what}" for entry, what in real.items() if own.get(entry) != what]
    assert not different, "\n".join(different)


def newer_lines(own, real):
    """The lines of our definition that the real one does not have, and the other way round."""
    return set(own.splitlines()) - set(real.splitlines()), set(real.splitlines()) - set(own.splitlines())


def test_the_definition_is_that_of_the_real_client(information):
    different = []
    for name in BOTH_KNOW:
        own = describe(message_class(name)).replace("gz.msgs", "ignition.msgs").replace("gz/msgs", "ignition/msgs")
        # Where one of the two has fields that the other lacks, what both have must still be written alike.
        ours, real = newer_lines(own, information[name])
        own_fields = {line.split(" = ")[0] for line in ours}
        different += [f"{name}: {field}" for field in own_fields & {line.split(" = ")[0] for line in real}]
    assert not different, "\n".join(different)


@pytest.fixture(scope="module")
def echoes(shared_stage):
    """Type name -> (publishing participant, real echo that listens to it); only the last one asked for is running."""
    participant, started = shared_stage.participant(), {}

    def echo(name):
        if name not in started:
            for old in started.values():
                old.end()
            started.clear()
            topic = f"/{name}"
            participant.ask("advertise", topic, name)
            started[name] = shared_stage.real_topic("-e", "-t", topic)
            assert participant.ask("wait", topic)
        return participant, started[name]

    return echo


@pytest.mark.parametrize("name", BOTH_KNOW)
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


@pytest.mark.proof
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
