"""Our side of a conversation with the real client: does what it is told on stdin, in JSON lines, and answers."""

import json
import os
import sys
import threading

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.transport import Node

node = Node()
publishers = {}
writing = threading.Lock()


def say(**answer):
    with writing:
        os.write(1, (json.dumps(answer) + "\n").encode())


def serve(request):
    answer = type(request)()
    answer.CopyFrom(request)
    answer.data = request.data.upper()
    return request.data != "fail", answer


for line in sys.stdin:
    order = json.loads(line)
    name, types = order.get("name"), order.get("types", [])
    match order["do"]:
        case "advertise":
            publishers[name] = node.advertise(name, types[0])
            say(answer=True)
        case "wait":
            say(answer=publishers[name].wait_for_subscribers(1, 20.0))
        case "publish":
            for data in order["messages"]:
                publishers[name].publish_raw(bytes.fromhex(data), publishers[name].type_name)
            say(answer=True)
        case "subscribe":
            node.subscribe_raw(name, lambda data, info, name=name: say(heard=[name, info.type, data.hex()]), *types)
            say(answer=True)
        case "serve":
            say(answer=node.advertise_service(name, message_class(types[0]), message_class(types[1]), serve))
        case "serve for fortress":
            from gz_course.sim.gz.transport.options import AdvertiseServiceOptions

            options = AdvertiseServiceOptions(fortress=True)
            say(answer=node.advertise_service(name, types[0], types[1], serve, options))
        case "serve one-way":
            node.advertise_service(name, types[0], types[1], lambda request: say(heard=["", "", request.data]))
            say(answer=True)
        case "topics":
            say(answer=node.topic_list())
        case "publishers":
            say(answer=[[each.addr, each.msg_type_name] for each in node.topic_info(name)[0]])
