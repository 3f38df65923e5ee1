# Processes that leave their group, hear no signal and do not die with their parent.
import ctypes
import os
import signal
import time

for _ in range(5):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            for number in set(signal.Signals) - {signal.SIGKILL, signal.SIGSTOP}:
                signal.signal(number, signal.SIG_IGN)
            ctypes.CDLL(None).prctl(1, 0)
            time.sleep(600)
        os._exit(0)
    os.wait()
print("held", flush=True)
