# Tells once a second of a process that it has started, which never comes.
import json
import os
import socket
import threading
import time

some = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
some.connect(os.environ["COURSE_SOCKET"])


def tell():
    pid = 100_000
    while True:
        pid += 1
        some.send(json.dumps({"started": {"pid": pid, "program": "python3"}}).encode())
        time.sleep(1.0)


threading.Thread(target=tell, daemon=True).start()
