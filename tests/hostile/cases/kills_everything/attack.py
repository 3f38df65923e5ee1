import os
import signal

mine = {int(task) for task in os.listdir("/proc/self/task")}
for number in (signal.SIGTERM, signal.SIGINT, signal.SIGSTOP, signal.SIGKILL):
    for pid in (-1, os.getppid(), 1, *(n for n in range(2, 5000) if n not in mine)):
        try:
            os.kill(pid, number)
        except OSError:
            pass
print("held", flush=True)
