# Reports a megabyte of endpoints over and over again.
import json
import os
import socket
import threading

ENDPOINT = {"node": "/n", "kind": "publisher", "topic": "/x", "type": "std_msgs/msg/Empty", "reliability": "RELIABLE",
            "durability": "VOLATILE", "matched": 0}
some = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
some.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
some.connect(os.environ["COURSE_SOCKET"])
some.send(json.dumps({"hello": {"pid": os.getpid(), "group": os.getpgid(0), "command": ["python", "x"]}}).encode())


def report():
    number = 0
    while True:
        number += 1
        ends = [ENDPOINT | {"topic": f"/x{number}_{each}"} for each in range(1000)]
        some.send(json.dumps({
            "clock": None, "idle": True, "taken": {}, "published": {}, "delivered": {}, "holding": True, "held": 0,
            "released": 0, "flushes": 0, "endpoints": ends,
        }).encode())


threading.Thread(target=report, daemon=True).start()
