"""Jobs for a supervised child process: in a module of their own, so that a new Python can import them."""

import faulthandler
import os
import signal
import subprocess
import sys
import time

from gz_course.grader.errors import UsageError


def doubled(number, heartbeat):
    heartbeat.at(number)
    return 2 * number


def complains(heartbeat):
    raise UsageError("this is no submission")


def computes(heartbeat):
    heartbeat.submitted()
    while True:
        pass


def hears(heartbeat):
    while True:
        pass


def sleeps(heartbeat):
    while True:
        time.sleep(60)


def starts_one_that_computes(heartbeat):
    subprocess.run([sys.executable, "-c", "while True: pass"], check=False)


def fills_memory(heartbeat):
    heartbeat.submitted()
    held = []
    while True:
        held.append(bytearray(os.urandom(1 << 20) * 16))


def asks_for_all_memory(heartbeat):
    heartbeat.submitted()
    return bytearray(1 << 44)


def crashes(number, handed_in, heartbeat):
    faulthandler.disable()  # pytest's; the crash is meant
    if handed_in:
        heartbeat.submitted()
    os.kill(os.getpid(), number)


def daemon(heartbeat):
    if os.fork() == 0:
        os.setsid()
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(600)
    sleeps(heartbeat)
