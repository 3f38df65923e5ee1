"""Messages within one process, and the end of forgotten nodes, as with the official binding."""

import gc
import threading

import pytest

from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import AdvertiseMessageOptions, MessageInfo, Node, NodeOptions, Scope, process_network
from gz_course.sim.gz.transport import local_delivery as module
from gz_course.sim.gz.transport.local_delivery import LocalDelivery
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD

DEADLINE_S = 120


@pytest.fixture
def node():
    with Node() as each:
        yield each


def text(number):
    return StringMsg(data=str(number))


def finish(node, inbox):
    """Wait until the thread has done all that was queued before."""
    node.subscribe(StringMsg, "/finish", inbox)
    node.advertise("/finish", StringMsg).publish(text("end"))
    assert inbox.take()[0].data == "end"


def test_a_program_may_publish_while_it_holds_a_lock_that_its_callback_takes(node):
    lock, heard = threading.Lock(), threading.Event()
    threads = []

    def callback(message):
        with lock:
            threads.append(threading.current_thread())
            heard.set()

    node.subscribe(StringMsg, "/chat", callback)
    publisher = node.advertise("/chat", StringMsg)

    def publish():
        with lock:
            publisher.publish(text(1))

    program = threading.Thread(target=publish, daemon=True)
    program.start()
    program.join(DEADLINE_S)
    assert not program.is_alive()
    assert heard.wait(DEADLINE_S)
    assert threads[0] not in (program, threading.current_thread())


@pytest.mark.parametrize("scope", [Scope.PROCESS, Scope.ALL])
def test_all_messages_arrive_in_order_in_one_thread(node, inbox, scope):
    threads = set()

    def callback(message):
        threads.add(threading.get_ident())
        inbox(message)

    node.subscribe(StringMsg, "/chat", callback)
    publisher = node.advertise("/chat", StringMsg, AdvertiseMessageOptions(scope))
    for number in range(1000):
        assert publisher.publish(text(number))
    assert [message.data for message in inbox.take(1000)] == [str(number) for number in range(1000)]
    assert len(threads) == 1
    assert threading.get_ident() not in threads


def test_a_callback_may_publish_unsubscribe_and_fail(node, inbox, capsys):
    answers = node.advertise("/answer", StringMsg)
    node.subscribe(StringMsg, "/answer", inbox)

    def leave(message):
        answers.publish(message)
        node.unsubscribe("/chat")
        raise SystemExit

    node.subscribe(StringMsg, "/chat", leave)
    publisher = node.advertise("/chat", StringMsg)
    for number in range(3):
        publisher.publish(text(number))
    assert [message.data for message in inbox.take()] == ["0"]
    finish(node, inbox)
    assert "SystemExit" in capsys.readouterr().err


def test_synchronous_nodes_hear_before_publish_returns(node):
    here = threading.get_ident()
    for options in (NodeOptions(synchronous=True), NodeOptions(scope=Scope.PROCESS)):
        heard = []
        with Node(options) as synchronous:
            assert synchronous.options.synchronous
            synchronous.subscribe(StringMsg, "/chat", lambda message, heard=heard: heard.append(threading.get_ident()))
            node.advertise("/chat", StringMsg).publish(text(1))
        assert heard == [here]
        node.close()
        node = Node()


def test_a_slow_callback_is_told_once(monkeypatch, capsys):
    monkeypatch.setattr(module, "MANY_WAITING", 10)
    release = threading.Event()
    delivery = LocalDelivery()
    info, done = MessageInfo("/chat", "gz.msgs.StringMsg", "", True), threading.Event()

    class Slow:
        def deliver(self, data, info, from_node):
            release.wait(DEADLINE_S)

    class Last:
        def deliver(self, data, info, from_node):
            done.set()

    for _ in range(40):
        delivery.deliver((Slow(),), b"", info, "")
    delivery.deliver((Last(),), b"", info, "")
    release.set()
    assert done.wait(DEADLINE_S)
    (line,) = capsys.readouterr().err.splitlines()
    assert "[/chat]" in line


def test_a_forgotten_node_hears_nothing_and_leaves_the_tables(inbox):
    """A cell of a notebook that is run twice makes a node twice."""
    heard = []
    with Node() as other:
        publisher = other.advertise("/chat", StringMsg)
        for run in range(2):
            node = Node()
            node.subscribe(StringMsg, "/chat", lambda message, run=run: heard.append(run))
            own = node.advertise("/own", StringMsg)
            node.advertise_service("/serve", StringMsg, StringMsg, lambda request: request)
        del node
        assert own.valid()
        assert own.publish(text(1)) is True
        assert other.topic_info("/own")[1] == []
        del own
        gc.collect()
        assert not publisher.has_connections()
        publisher.publish(text(1))
        finish(other, inbox)
        assert heard == []
        assert other.topic_list() == ["/chat", "/finish"]
        assert other.service_list() == []


def test_the_node_of_this_run_still_hears(inbox):
    node = Node()
    node.subscribe(StringMsg, "/chat", inbox)
    node = Node()
    node.subscribe(StringMsg, "/chat", inbox)
    node.advertise("/chat", StringMsg).publish(text(1))
    assert inbox.take()[0].data == "1"
    finish(node, inbox)
    assert inbox.empty()


def test_a_publisher_outlives_its_node_if_the_program_keeps_it(inbox, node):
    publisher = Node().advertise("/chat", StringMsg)
    node.subscribe(StringMsg, "/chat", inbox)
    assert publisher.publish(text(1))
    assert inbox.take()[0].data == "1"
    name = publisher.name
    del publisher
    assert SWITCHBOARD.wait_for(lambda: SWITCHBOARD.publishers(name) == (), DEADLINE_S)


def test_a_forgotten_node_without_a_thread_is_tidied_by_the_next_one(monkeypatch):
    from gz_course.sim.gz.transport import node as node_module
    from gz_course.sim.gz.transport import publisher as publisher_module

    delivery = LocalDelivery()
    monkeypatch.setattr(process_network, "_network", None)
    monkeypatch.setattr(node_module, "LOCAL_DELIVERY", delivery)
    monkeypatch.setattr(publisher_module, "LOCAL_DELIVERY", delivery)
    node = Node(NodeOptions(scope=Scope.PROCESS))
    name = node.advertise("/chat", StringMsg).name
    node.subscribe(StringMsg, "/chat", print)
    del node
    assert len(SWITCHBOARD.publishers(name)) == 1
    assert delivery._thread is None
    with Node(NodeOptions(scope=Scope.PROCESS)):
        assert (SWITCHBOARD.publishers(name), SWITCHBOARD.subscriptions(name)) == ((), ())
