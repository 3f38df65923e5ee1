"""The sending process of bench_transport: publishes with gz.transport or with a bare pyzmq PUB socket, as ordered."""

import json
import sys
import threading
import time

import zmq

from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node

KINDS = {"100 B": StringMsg, "6 kB": LaserScan, "0.9 MB": Image}


def example(kind):
    """A message of about the size of its name; its header holds the time of sending [ns]."""
    if kind == "100 B":
        message = StringMsg(data="x" * 80)
    elif kind == "6 kB":
        message = LaserScan(ranges=[1.0 + 0.001 * i for i in range(360)], intensities=[0.5] * 360)
    else:
        message = Image(width=640, height=480, step=1920, data=bytes(921_600))
    stamp(message)
    return message


def stamp(message):
    message.header.stamp.sec = time.monotonic_ns()


def paced(count, rate, send):
    """Calls send() so many times at so many hertz, as fast as possible when the rate is 0."""
    start = time.monotonic()
    for number in range(count):
        if rate:
            due = start + number / rate
            while (left := due - time.monotonic()) > 0:
                time.sleep(min(left, 0.0005))
        send()


def main():
    node, context, publishers = Node(), zmq.Context(), {}
    bare = context.socket(zmq.XPUB)
    bare.sndhwm = 0
    port = bare.bind_to_random_port("tcp://127.0.0.1")
    print(json.dumps({"port": port}), flush=True)
    for line in sys.stdin:
        order = json.loads(line)
        match order["do"]:
            case "publish":
                message = example(order["kind"])
                topic = order["topic"]
                if topic not in publishers:
                    publishers[topic] = node.advertise(topic, type(message))
                publisher = publishers[topic]
                assert publisher.wait_for_subscribers(timeout=10)

                def send(message=message, publisher=publisher):
                    stamp(message)
                    publisher.publish(message)

            case "bare":
                message = example(order["kind"])
                while b"\x01" + order["topic"].encode() != bare.recv():
                    pass
                name, address = order["topic"].encode(), f"tcp://127.0.0.1:{port}".encode()
                kind = message.DESCRIPTOR.full_name.encode()

                def send(message=message, name=name, address=address, kind=kind):
                    stamp(message)
                    bare.send_multipart((name, address, message.SerializeToString(), kind))

            case "advertise":
                started = time.monotonic_ns()
                publisher = node.advertise(order["topic"], StringMsg)
                publisher.wait_for_subscribers(timeout=10)
                message = StringMsg(data="first")
                message.header.stamp.sec = started
                publisher.publish(message)
                continue
            case "serve":
                node.advertise_service(order["topic"], StringMsg, StringMsg, lambda request: request)
                print(json.dumps({"served": True}), flush=True)
                continue
        threading.Thread(target=paced, args=(order["count"], order["rate"], send)).start()


if __name__ == "__main__":
    main()
