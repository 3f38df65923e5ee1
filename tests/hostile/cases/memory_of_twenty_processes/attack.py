import os
import time

for _ in range(20):
    if os.fork() == 0:
        hoard = bytearray(b"x" * (160 << 20))
        time.sleep(600)
time.sleep(600)
