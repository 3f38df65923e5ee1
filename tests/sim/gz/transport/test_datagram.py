import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import datagram

texts = st.text(max_size=40)


def test_a_heartbeat_of_a_real_gazebo_process_is_understood():
    uuid = b"0d7e7b5a-6f6c-4a2e-9d3b-6a5e9c1b2f30"
    data = bytes.fromhex("2a00100a1a24") + uuid + bytes.fromhex("2004")
    message = datagram.decode(data)
    assert (message.type, message.process_uuid) == (Discovery.HEARTBEAT, uuid.decode())
    assert datagram.encode(message) == data


@given(
    st.sampled_from(Discovery.Type.values()),
    texts.filter(bool),
    texts,
    texts,
    st.integers(0, 2),
    st.integers(0, 2**64 - 1),
)
def test_decoding_undoes_encoding(kind, process, topic, type_name, scope, rate):
    message = Discovery(version=10, process_uuid=process, type=kind)
    message.pub.topic = topic
    message.pub.scope = scope
    message.pub.msg_pub.msg_type = type_name
    message.pub.msg_pub.msgs_per_sec = rate
    assert datagram.decode(datagram.encode(message)) == message


@given(st.binary(max_size=300))
def test_random_bytes_are_dropped_or_understood(data):
    for candidate in (data, len(data).to_bytes(2, "little") + data):
        message = datagram.decode(candidate)
        assert message is None or (message.version == 10 and message.process_uuid)


@given(st.data())
def test_a_damaged_datagram_is_dropped_or_understood(data):
    message = Discovery(version=10, process_uuid="p", type=Discovery.ADVERTISE)
    message.pub.topic = "@/p@/topic"
    good = bytearray(datagram.encode(message))
    good[data.draw(st.integers(0, len(good) - 1))] = data.draw(st.integers(0, 255))
    datagram.decode(bytes(good))
    assert datagram.decode(bytes(good[: data.draw(st.integers(0, len(good) - 1))])) is None


@pytest.mark.parametrize(
    "message",
    [Discovery(version=9, process_uuid="p"), Discovery(version=110, process_uuid="p"), Discovery(version=10)],
)
def test_other_versions_and_nameless_processes_are_dropped(message):
    assert datagram.decode(datagram.encode(message)) is None


def test_a_message_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="65535"):
        datagram.encode(Discovery(process_uuid="p" * 65535))
