import contextlib
import json
import os
import queue
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import uuid
from pathlib import Path

import pytest

FOLDER = Path("/usr/libexec/ignition/transport11")
TOPIC, SERVICE = FOLDER / "ign-transport-topic", FOLDER / "ign-transport-service"
GZ = Path(sys.executable).with_name("gz")
DEADLINE_S = 120.0
ABSENT = (
    "conformance with a real Gazebo client was NOT tested: install the package ignition-transport-cli "
    "(Debian 12: apt-get install ignition-transport-cli)"
)


def pytest_collection_modifyitems(items):
    if not (TOPIC.is_file() and SERVICE.is_file()):
        for item in items:
            if Path(__file__).parent in item.path.parents and getattr(item.module, "NEEDS_CLIENT", True):
                item.add_marker(pytest.mark.skip(reason=ABSENT))


def pytest_terminal_summary(terminalreporter):
    skipped = terminalreporter.stats.get("skipped", [])
    if any(ABSENT in str(report.longrepr) for report in skipped):
        terminalreporter.section("WARNING", yellow=True, bold=True)
        terminalreporter.write_line(f"WARNING: {ABSENT}", yellow=True, bold=True)


class Program:
    """A child process, what it has printed so far, and its end."""

    def __init__(self, command, environment, **options):
        self.process = subprocess.Popen(
            [str(part) for part in command],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            start_new_session=True,
            **options,
        )
        self._texts = {"out": b"", "error": b""}
        self._changed = threading.Condition()
        streams = {"out": self.process.stdout, "error": self.process.stderr}
        self._readers = [threading.Thread(target=self._read, args=item) for item in streams.items()]
        for reader in self._readers:
            reader.start()

    def _read(self, name, stream):
        while part := os.read(stream.fileno(), 65536):
            with self._changed:
                self._texts[name] += part
                self._changed.notify_all()

    @property
    def out(self):
        return self._texts["out"].decode()

    @property
    def error(self):
        return self._texts["error"].decode()

    def wait_for(self, condition, timeout=DEADLINE_S):
        """Waits until condition(output so far); whether it came true."""
        with self._changed:
            return self._changed.wait_for(lambda: condition(self.out), timeout)

    def take(self, size):
        """The next `size` bytes of the output, or what has come of them until the deadline."""
        with self._changed:
            self._changed.wait_for(lambda: len(self._texts["out"]) >= size, DEADLINE_S)
            taken = self._texts["out"]
            self._texts["out"] = b""
        return taken.decode()

    def end(self, number=signal.SIGINT):
        """Interrupts the program if it runs; its exit code."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, number)
        try:
            code = self.process.wait(60)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            code = self.process.wait(60)
        return self._finish(code)

    def wait(self):
        """Waits until the program ends by itself; its exit code."""
        try:
            code = self.process.wait(DEADLINE_S)
        except subprocess.TimeoutExpired:
            code = self.end(signal.SIGKILL)
        return self._finish(code)

    def _finish(self, code):
        for reader in self._readers:
            reader.join(DEADLINE_S)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            if stream is not None:
                with contextlib.suppress(BrokenPipeError):
                    stream.close()
        return code


class Participant:
    """participant.py as a child process."""

    def __init__(self, environment):
        self.process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("participant.py"))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
            start_new_session=True,
        )
        self._answers, self.heard = queue.Queue(), queue.Queue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            said = json.loads(line)
            (self.heard if "heard" in said else self._answers).put(next(iter(said.values())))

    def ask(self, do, name="", *types, **more):
        self.process.stdin.write(json.dumps({"do": do, "name": name, "types": types, **more}) + "\n")
        self.process.stdin.flush()
        return self._answers.get(timeout=DEADLINE_S)

    def close(self):
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait(5)
        self._reader.join(DEADLINE_S)
        self.process.stdout.close()


class Stage:
    """A network of its own, with programs of both kinds on it."""

    def __init__(self):
        self._ended = []
        values = {
            "PARTITION": f"conformance-{uuid.uuid4()}",
            "IP": "127.0.0.1",
            "DISCOVERY_MSG_PORT": str(free_port()),
            "DISCOVERY_SRV_PORT": str(free_port()),
        }
        both = {f"{prefix}_{name}": value for name, value in values.items() for prefix in ("GZ", "IGN")}
        self.environment = {**os.environ, **both}

    def _start(self, program, *arguments):
        started = Program([program, *arguments], self.environment)
        self._ended.append(started.end)
        return started

    def real_topic(self, *arguments):
        return self._start(TOPIC, *arguments)

    def real_service(self, *arguments):
        return self._start(SERVICE, *arguments)

    def gz(self, *arguments):
        return self._start(GZ, *arguments)

    def participant(self):
        started = Participant(self.environment)
        self._ended.append(started.close)
        return started

    def close(self):
        for end in reversed(self._ended):
            end()


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def stage():
    with contextlib.closing(Stage()) as each:
        yield each


@pytest.fixture(scope="module")
def shared_stage():
    with contextlib.closing(Stage()) as each:
        yield each


@pytest.fixture
def until():
    """Runs a program again and again until its output is as wanted: a list may miss what announces itself late."""

    def repeat(start, condition):
        deadline = time.monotonic() + DEADLINE_S
        while True:
            program = start()
            code = program.wait()
            if condition(program.out) or time.monotonic() > deadline:
                return code, program.out, program.error

    return repeat


class Library:
    """The type definitions in the real client's library."""

    def __init__(self):
        self._definitions = {}

    def _call(self, function, *arguments):
        program = (
            "import ctypes, sys; library = ctypes.CDLL('libignition-msgs8.so.8');"
            "[getattr(library, sys.argv[1])(each.encode()) for each in sys.argv[2:]]"
        )
        done = subprocess.run(
            [sys.executable, "-c", program, function, *arguments], capture_output=True, text=True, timeout=DEADLINE_S
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    def names(self):
        return [name.replace("ign_msgs.", "ignition.msgs.") for name in self._call("cmdMsgList", "").split()]

    def information(self, names):
        """Type name -> what `ign msg --info` prints about it."""
        parts = re.split(r"^(?=Name: )", self._call("cmdMsgInfo", *names), flags=re.MULTILINE)[1:]
        return {part.partition("\n")[0].removeprefix("Name: "): part for part in parts}


@pytest.fixture(scope="session")
def library():
    return Library()
