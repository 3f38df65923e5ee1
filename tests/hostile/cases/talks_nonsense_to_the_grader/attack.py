# Connections to the grader by somebody it does not expect, and what nobody would send.
import json
import os
import socket

path = next(value for name, value in os.environ.items() if name.startswith("COURSE_") and os.path.exists(value))
for text in (b"", b"{}", b"[" * 60_000, b"\xff" * 1000, json.dumps({"hello": {"pid": 1, "group": -1}}).encode(), b"null"):
    for _ in range(30):
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as some:
            some.setblocking(False)
            try:
                some.connect(path)
                some.send(text)
            except OSError:
                pass
print("held", flush=True)
