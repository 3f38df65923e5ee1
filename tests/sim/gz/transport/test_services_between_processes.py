"""Services between processes, as seen from both sides."""

import threading
import time

import pytest

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.int32_pb2 import Int32
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

PATIENCE_MS = 120_000


@pytest.fixture
def node():
    with Node() as each:
        yield each


def ask(node, service, text="hello", timeout_ms=PATIENCE_MS, response=StringMsg):
    return node.request(service, StringMsg(data=text), StringMsg, response, timeout_ms)


def ask_until_answered(node, service):
    """Repeat the request, because the first one may be sent to a provider that was just killed."""
    deadline = time.monotonic() + PATIENCE_MS / 1000
    while time.monotonic() < deadline:
        answered, response = ask(node, service, timeout_ms=1000)
        if answered:
            return response.data
    return None


def test_provider_there_first_or_later(node, start_peer):
    peer = start_peer()
    peer.ask("serve", service="/shout", answer="upper")
    assert ask(node, "/shout") == (True, StringMsg(data="HELLO"))
    answers = []
    waiting = threading.Thread(target=lambda: answers.append(ask(node, "/later")))
    waiting.start()
    peer.ask("serve", service="/later", answer="upper")
    waiting.join()
    assert answers == [(True, StringMsg(data="HELLO"))]


def test_provider_here(node, start_peer):
    node.advertise_service("/shout", StringMsg, StringMsg, lambda request: StringMsg(data=request.data.upper()))
    peer = start_peer()
    for text in ("one", "two"):
        answer = peer.ask("request", service="/shout", text=text, timeout_ms=PATIENCE_MS)
        assert answer == [True, text.upper()]


@pytest.mark.parametrize("answer", ["false", "raise", "exit", "nothing", "wrong type"])
def test_what_goes_wrong_there_is_a_failure_and_the_service_lives_on(node, start_peer, answer):
    peer = start_peer()
    peer.ask("serve", service="/bad", answer=answer)
    peer.ask("serve", service="/good", answer="upper")
    types = ("gz.msgs.StringMsg", "gz.msgs.StringMsg")
    for _ in range(2):
        assert node.call_raw("/bad", b"", *types, PATIENCE_MS) == (True, False, b"")
    assert ask(node, "/good")[0]


def test_one_way(node, start_peer):
    peer = start_peer()
    peer.ask("serve", service="/tell", answer="one way")
    for text in ("first", "second"):
        assert ask(node, "/tell", text, response=Empty) == (True, Empty())
    assert peer.heard(2) == [("one way", "first"), ("one way", "second")]
    assert ask(node, "/nobody", timeout_ms=50, response=Empty) == (False, Empty())


def test_nobody_or_other_types_is_a_timeout(node, start_peer):
    peer = start_peer()
    peer.ask("serve", service="/shout", answer="upper")
    assert ask(node, "/shout")[0]
    assert ask(node, "/nobody", timeout_ms=50) == (False, StringMsg())
    assert ask(node, "/shout", timeout_ms=50, response=Int32) == (False, Int32())
    assert node.request("/shout", Int32(), Int32, StringMsg, 50) == (False, StringMsg())


def test_a_provider_that_dies_is_a_timeout_and_its_successor_answers(node, start_peer):
    for _ in range(2):
        peer = start_peer()
        peer.ask("serve", service="/die", answer="die")
        peer.ask("serve", service="/pid", answer="pid")
        assert ask_until_answered(node, "/pid") == str(peer.process.pid)
        assert ask(node, "/die", timeout_ms=200) == (False, StringMsg())
        peer.kill()


def test_several_providers(node, start_peer):
    peers = [start_peer(), start_peer()]
    for peer in peers:
        peer.ask("serve", service="/pid", answer="pid")
    first = ask(node, "/pid")[1].data
    peers.sort(key=lambda peer: str(peer.process.pid) != first)
    peers[0].kill()
    assert ask_until_answered(node, "/pid") == str(peers[1].process.pid)


def test_own_provider_is_preferred(node, start_peer):
    start_peer().ask("serve", service="/pid", answer="pid")
    assert ask(node, "/pid")[0]
    node.advertise_service("/pid", StringMsg, StringMsg, lambda request: StringMsg(data="here"))
    assert ask(node, "/pid") == (True, StringMsg(data="here"))


def test_lists(node, start_peer):
    peer = start_peer()
    peer.ask("serve", service="/a", answer="one way")
    peer.ask("serve", service="/b", answer="upper")
    assert ask(node, "/b")[0]  # what was announced before is known, too
    assert node.service_list() == ["/a", "/b"]
    (provider,) = node.service_info("/a")
    assert provider.addr.startswith("tcp://127.0.0.1:")
    assert (provider.req_type_name, provider.rep_type_name) == ("gz.msgs.StringMsg", "gz.msgs.Empty")
    assert peer.ask("unserve", service="/a")
    peer.ask("serve", service="/c", answer="upper")
    assert ask(node, "/c")[0]  # messages after the farewell of /a are processed
    assert node.service_list() == ["/b", "/c"]


def test_callbacks_that_ask_one_another(node, start_peer):
    node.advertise_service("/back", StringMsg, StringMsg, lambda request: ask(node, "/inner", request.data))
    peer = start_peer()
    peer.ask("serve", service="/ask", answer="ask back")
    peer.ask("serve", service="/inner", answer="upper")
    assert ask(node, "/ask", "nested") == (True, StringMsg(data="NESTED"))


def test_a_request_inside_a_topic_callback(node, start_peer, inbox):
    peer = start_peer()
    peer.ask("serve", service="/shout", answer="upper")
    node.subscribe(StringMsg, "/chat", lambda message: inbox(ask(node, "/shout", message.data)))
    peer.ask("advertise", topic="/chat")
    assert peer.ask("wait", topic="/chat")
    peer.ask("publish", topic="/chat", text="psst")
    assert inbox.take() == [(True, StringMsg(data="PSST"))]


def test_many_threads_ask_publish_and_subscribe_at_once(node, start_peer):
    peer = start_peer()
    peer.ask("serve", service="/shout", answer="upper")
    peer.ask("subscribe", topic="/chat")
    publisher = node.advertise("/chat", StringMsg)
    assert publisher.wait_for_subscribers(timeout=120)
    wrong = []

    def work(number):
        for turn in range(50):
            text = f"t{number} {turn}"
            if ask(node, "/shout", text) != (True, StringMsg(data=text.upper())):
                wrong.append(text)
            publisher.publish(StringMsg(data=text))
            node.subscribe(StringMsg, f"/noise{number}", lambda message: None)
            node.unsubscribe(f"/noise{number}")

    threads = [threading.Thread(target=work, args=(number,)) for number in range(10)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []
    assert sorted(text for _, text in peer.heard(500)) == sorted(f"t{n} {t}" for n in range(10) for t in range(50))


def test_partitions_and_process_scope_are_separate(node, start_peer):
    with Node(NodeOptions(partition="elsewhere")) as other, Node(NodeOptions(scope=Scope.PROCESS)) as hidden:
        hidden.advertise_service("/hidden", StringMsg, StringMsg, lambda request: request)
        other.advertise_service("/other", StringMsg, StringMsg, lambda request: request)
        node.advertise_service("/open", StringMsg, StringMsg, lambda request: request)
        peer = start_peer()
        assert peer.ask("request", service="/open", text="x", timeout_ms=PATIENCE_MS) == [True, "x"]
        for service in ("/hidden", "/other"):
            assert peer.ask("request", service=service, text="x", timeout_ms=100) == [False, ""]
        peer.ask("serve", service="/there", answer="upper")
        assert ask(node, "/there")[0]
        assert ask(hidden, "/there", timeout_ms=50) == (False, StringMsg())


def test_a_forked_child_calls_and_its_parent_goes_on(node, start_peer):
    node.advertise_service("/shout", StringMsg, StringMsg, lambda request: StringMsg(data=request.data.upper()))
    peer = start_peer()
    call = {"service": "/shout", "timeout_ms": PATIENCE_MS}
    assert peer.ask("request", text="before", **call) == [True, "BEFORE"]
    assert peer.ask("request from fork", service="/shout", text="child") == 0
    assert peer.ask("request", text="after", **call) == [True, "AFTER"]
    code, errors = peer.finish()
    assert (code, errors) == (0, "")
