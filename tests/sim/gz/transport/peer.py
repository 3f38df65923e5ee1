"""Another process for the tests: executes JSON lines from stdin and answers on stdout."""

import json
import os
import signal
import sys
import threading
import warnings

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, NodeOptions

node = Node()
nodes = {"": node}
publishers = {}
writing = threading.Lock()


def say(**answer):
    with writing:
        os.write(1, (json.dumps(answer) + "\n").encode())


def ask_back(request):
    """Call a service of the requester before answering."""
    return node.request("/back", request, StringMsg, StringMsg, 10_000)


def die(request):
    os.kill(os.getpid(), signal.SIGKILL)


ANSWERS = {
    "upper": lambda request: StringMsg(data=request.data.upper()),
    "pid": lambda request: StringMsg(data=str(os.getpid())),
    "false": lambda request: (False, StringMsg(data="ignored")),
    "raise": lambda request: 1 / 0,
    "exit": lambda request: sys.exit(3),
    "nothing": lambda request: None,
    "wrong type": lambda request: Empty(),
    "die": die,
    "ask back": ask_back,
    "one way": lambda request: say(heard=["one way", request.data]),
}


def publish_from_threads(publisher, threads, count):
    def work(thread):
        for number in range(count):
            publisher.publish(StringMsg(data=f"{thread} {number}"))

    workers = [threading.Thread(target=work, args=(number,)) for number in range(threads)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()


def publish_from_forked_child(publisher, text):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # newer Pythons warn of forking beside threads
        child = os.fork()
    if child == 0:
        arrived = publisher.wait_for_subscribers(timeout=120)
        publisher.publish(StringMsg(data=text))
        sys.exit(0 if arrived else 1)  # runs the exit handlers of the child
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def request_from_forked_child(service, text):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # newer Pythons warn of forking beside threads
        child = os.fork()
    if child == 0:
        done, response = node.request(service, StringMsg(data=text), StringMsg, StringMsg, 20_000)
        sys.exit(0 if done and response.data == text.upper() else 1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


for line in sys.stdin:
    order = json.loads(line)
    match order["do"]:
        case "advertise":
            partition = order.get("partition")
            chosen = nodes.setdefault(partition, Node(NodeOptions(partition=partition))) if partition else node
            publishers[order["topic"]] = chosen.advertise(order["topic"], StringMsg)
            say(answer=True)
        case "publish":
            say(answer=publishers[order["topic"]].publish(StringMsg(data=order["text"])))
        case "close":
            publishers.pop(order["topic"]).close()
            say(answer=True)
        case "wait":
            say(answer=publishers[order["topic"]].wait_for_subscribers(order.get("count", 1), 20.0))
        case "subscribe":
            topic = order["topic"]
            node.subscribe(StringMsg, topic, lambda message, topic=topic: say(heard=[topic, message.data]))
            say(answer=True)
        case "measure":
            topic = order["topic"]
            node.enable_stats(topic, True)
            node.subscribe(StringMsg, topic, lambda message, topic=topic: say(heard=[topic, message.data]))
            say(answer=True)
        case "measured":
            counted = node.topic_stats(order["topic"])
            say(answer=[counted.age.count, counted.dropped_message_count])
        case "unsubscribe":
            say(answer=node.unsubscribe(order["topic"]))
        case "threads":
            publish_from_threads(publishers[order["topic"]], order["threads"], order["count"])
            say(answer=True)
        case "fork":
            say(answer=publish_from_forked_child(publishers[order["topic"]], order["text"]))
        case "serve":
            answer = ANSWERS[order["answer"]]
            response = Empty if order["answer"] == "one way" else StringMsg
            say(answer=node.advertise_service(order["service"], StringMsg, response, answer))
        case "unserve":
            say(answer=node.unadvertise_service(order["service"]))
        case "request":
            request = StringMsg(data=order["text"])
            done, response = node.request(order["service"], request, StringMsg, StringMsg, order["timeout_ms"])
            say(answer=[done, response.data])
        case "request from fork":
            say(answer=request_from_forked_child(order["service"], order["text"]))
        case "crash":
            raise RuntimeError("as ordered")
