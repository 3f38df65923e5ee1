import contextlib
import os
import queue
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from gz_course.tests.warm_process import WarmPopen

GZ = Path(sys.executable).with_name("gz")
DEADLINE_S = 120.0


class Command:
    """`gz` as a child process, with its lines as they arrive and its end."""

    def __init__(self, *arguments):
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
        self.process = WarmPopen(
            [str(GZ), *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment,
            start_new_session=True,
        )
        self._lines = {"out": queue.Queue(), "error": queue.Queue()}
        streams = (("out", self.process.stdout), ("error", self.process.stderr))
        self._readers = [threading.Thread(target=self._read, args=each) for each in streams]
        for reader in self._readers:
            reader.start()

    def _read(self, name, stream):
        for line in stream:
            self._lines[name].put(line)

    def line(self, stream="out"):
        """Wait for the next line and return it."""
        return self._lines[stream].get(timeout=DEADLINE_S)

    def signal(self, number):
        os.killpg(self.process.pid, number)

    def end(self):
        """Wait for the end; return (exit code, remaining stdout, remaining stderr)."""
        code = self.process.wait(DEADLINE_S)
        for reader in self._readers:
            reader.join(DEADLINE_S)
        return code, *("".join(iter_queue(self._lines[name])) for name in ("out", "error"))

    def clean_up(self):
        if self.process.poll() is None:
            self.signal(signal.SIGKILL)
        self.end()
        self.process.stdout.close()
        self.process.stderr.close()


def iter_queue(lines):
    with contextlib.suppress(queue.Empty):
        while True:
            yield lines.get_nowait()


@pytest.fixture
def gz(partition):
    """Start `gz` in the partition of the test."""
    started = []

    def start(*arguments):
        started.append(Command(*arguments))
        return started[-1]

    yield start
    for each in started:
        each.clean_up()
