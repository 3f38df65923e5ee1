# A connection that says it holds a message, whatever it was told to release.
import json
import os
import socket
import threading

some = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
some.connect(os.environ["COURSE_SOCKET"])


def say(**message):
    some.send(json.dumps(message).encode())


ENDPOINT = {"node": "/liar", "kind": "publisher", "topic": "/x", "type": "std_msgs/msg/Empty"}
QOS = {"reliability": "RELIABLE", "durability": "VOLATILE", "matched": 0}
say(hello={"pid": os.getpid(), "group": os.getpgid(0), "command": ["python", "liar"]})
say(ros=True)
report = {"clock": None, "idle": True, "taken": {}, "published": {}, "delivered": {}, "holding": True, "flushes": 0}
report["endpoints"] = [ENDPOINT | QOS]
say(**report, held=1, released=0)


def obey():
    released = 0
    while True:
        order = json.loads(some.recv(1 << 20) or b"{}")
        released += "release" in order
        say(**report, held=1, released=released)


threading.Thread(target=obey, daemon=True).start()
