"""Services within one process."""

import threading

import pytest

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.int32_pb2 import Int32
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import AdvertiseServiceOptions, Node, NodeOptions, Scope


@pytest.fixture
def node():
    with Node(NodeOptions(scope=Scope.PROCESS)) as each:
        yield each


def upper(request):
    return StringMsg(data=request.data.upper())


def ask(node, service="/shout", text="hello"):
    return node.request(service, StringMsg(data=text), StringMsg, StringMsg, 100)


def test_request_and_response(node):
    assert node.advertise_service("/shout", StringMsg, StringMsg, upper) is True
    assert ask(node) == (True, StringMsg(data="HELLO"))


def test_the_callback_runs_in_the_thread_of_the_requester(node):
    threads = []
    node.advertise_service("/shout", StringMsg, Empty, lambda request: threads.append(threading.current_thread()))
    assert node.request("/shout", StringMsg(), StringMsg, Empty, 100) == (True, Empty())
    assert threads == [threading.current_thread()]


def test_a_service_without_arguments(node):
    node.advertise_service("/answer", Empty, Int32, lambda request: Int32(data=42))
    assert node.request("/answer", None, Empty, Int32) == (True, Int32(data=42))
    assert node.request("/answer", Empty(), Empty, Int32, 100) == (True, Int32(data=42))


def test_raw_requests(node):
    node.advertise_service("/shout", StringMsg, StringMsg, upper)
    data = StringMsg(data="a").SerializeToString()
    expected = (True, StringMsg(data="A").SerializeToString())
    assert node.request_raw("/shout", data, "gz.msgs.StringMsg", "gz.msgs.StringMsg", 100) == expected
    assert node.request_raw("/shout", data, "ignition.msgs.StringMsg", "ignition.msgs.StringMsg", 100) == expected
    assert node.request_raw("/shout", b"\xff", "gz.msgs.StringMsg", "gz.msgs.StringMsg", 100) == (False, b"")


def test_a_failure_is_told_from_silence(node):
    node.advertise_service("/no", StringMsg, StringMsg, lambda request: (False, StringMsg()))
    types = ("gz.msgs.StringMsg", "gz.msgs.StringMsg")
    assert node.call_raw("/no", b"", *types, 10) == (True, False, b"")
    assert node.call_raw("/nobody", b"", *types, 10) == (False, False, b"")


@pytest.mark.parametrize(
    ("callback", "said"),
    [
        (lambda request: 1 / 0, "[/shout] raised ZeroDivisionError: division by zero"),
        (lambda request: None, "returned NoneType, but a gz.msgs.StringMsg"),
        (lambda request: Empty(), "returned Empty, but a gz.msgs.StringMsg"),
        (lambda request: (True, "text"), "returned str, but a gz.msgs.StringMsg"),
    ],
)
def test_a_callback_that_goes_wrong_is_a_failure_and_one_line(node, capfd, callback, said):
    node.advertise_service("/shout", StringMsg, StringMsg, callback)
    assert ask(node) == (False, StringMsg())
    errors = capfd.readouterr().err
    assert said in errors
    assert errors.count("\n") == 1


def test_other_types_are_not_asked(node):
    asked = []
    node.advertise_service("/shout", StringMsg, StringMsg, lambda request: asked.append(request) or request)
    assert node.request("/shout", Int32(), Int32, StringMsg, 10) == (False, StringMsg())
    assert node.request("/shout", StringMsg(), StringMsg, Int32, 10) == (False, Int32())
    assert asked == []


def test_lists(node):
    assert node.service_list() == []
    node.advertise_service("/b", StringMsg, StringMsg, upper)
    node.advertise_service("/a", Empty, Int32, upper)
    assert node.service_list() == node.advertised_services() == ["/a", "/b"]
    (provider,) = node.service_info("/a")
    assert (provider.topic, provider.addr, provider.req_type_name, provider.rep_type_name) == (
        "/a",
        "",
        "gz.msgs.Empty",
        "gz.msgs.Int32",
    )
    assert provider.options.scope == Scope.PROCESS
    assert node.service_info("/c") == []
    with Node(NodeOptions(partition="other", scope=Scope.PROCESS)) as other:
        assert other.service_list() == []


def test_a_service_ends(node):
    assert node.unadvertise_service("/shout") is False
    node.advertise_service("/shout", StringMsg, StringMsg, upper)
    with Node(NodeOptions(scope=Scope.PROCESS)) as other:
        assert other.unadvertise_service("/shout") is False
        other.advertise_service("/short", StringMsg, StringMsg, upper)
    assert node.service_list() == ["/shout"]
    assert node.unadvertise_service("/shout") is True
    assert node.service_list() == []
    assert ask(node) == (False, StringMsg())
    node.advertise_service("/shout", StringMsg, StringMsg, upper)
    assert ask(node)[0]


def test_one_node_offers_a_service_once(node):
    node.advertise_service("/shout", StringMsg, StringMsg, upper)
    with pytest.raises(ValueError, match="already offered by this node"):
        node.advertise_service("/shout", StringMsg, Int32, upper)


def test_names_follow_the_rules_namespace_and_remapping(capsys):
    options = NodeOptions(namespace="robot", scope=Scope.PROCESS)
    options.add_topic_remap("/old", "/new")
    with Node(options) as node:
        node.advertise_service("shout", StringMsg, StringMsg, upper)
        node.advertise_service("/old", StringMsg, StringMsg, upper)
        assert node.service_list() == ["/new", "/robot/shout"]
        assert ask(node, "/robot/shout")[0]
        with pytest.raises(ValueError, match="service name '/a b' is not valid: it must not contain a space"):
            node.advertise_service("/a b", StringMsg, StringMsg, upper)
        assert not ask(node, "")[0]
        assert "service name '' is not valid" in capsys.readouterr().err


def test_wrong_arguments_are_named(node, capsys):
    with pytest.raises(TypeError, match="cannot be called"):
        node.advertise_service("/a", StringMsg, StringMsg, 3)
    with pytest.raises(TypeError, match="message class"):
        node.advertise_service("/a", int, StringMsg, upper)
    with pytest.raises(ValueError, match=r"no message type 'gz.msgs.Twost'.*gz.msgs.Twist"):
        node.advertise_service("/a", "gz.msgs.Twost", StringMsg, upper)
    assert node.request("/a", Empty(), StringMsg, StringMsg, 10) == (False, StringMsg())
    assert "is a gz.msgs.Empty, but the request type was given as gz" in capsys.readouterr().err
    with pytest.raises(ValueError, match="timeout is -1"):
        node.request("/a", StringMsg(), StringMsg, StringMsg, -1)
    assert node.service_list() == []


def test_a_closed_node_neither_offers_nor_asks(node):
    node.close()
    with pytest.raises(RuntimeError, match="closed"):
        node.advertise_service("/a", StringMsg, StringMsg, upper)
    with pytest.raises(RuntimeError, match="closed"):
        ask(node)


def test_fortress_names(node):
    node.advertise_service("/shout", StringMsg, StringMsg, upper, AdvertiseServiceOptions(fortress=True))
    (provider,) = node.service_info("/shout")
    assert (provider.req_type_name, provider.rep_type_name) == ("ignition.msgs.StringMsg",) * 2
    assert ask(node)[0]
