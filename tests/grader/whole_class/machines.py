"""Machines for a class on Dask: network namespaces, joined by a bridge in the one of the scheduler."""

import contextlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

DASK = [sys.executable, "-m", "dask"]
COURSE = [sys.executable, "-c", "from gz_course.grader.course import main; main()"]
PORT = 8786
# Loaded by a worker that has another version of the course.
OTHER_VERSION = "from gz_course.grader.whole_class import versions\nversions.version = lambda package: '0.0.1'\n"
# Loaded by a worker on whose machine no level of the sandbox works.
NO_SANDBOX = "from gz_course.grader.run.sandbox import probe\nprobe.try_level = lambda level: 'not today'\n"


class Network:
    """The machines `hub`, `home`, `a`, `b`, `c` with the addresses 10.77.0.1 and on."""

    NAMES = ("hub", "home", "a", "b", "c")

    def __init__(self, folder: Path, environment):
        self.folder, self._environment = folder, environment
        self._prefix = f"course{os.getpid()}"
        self.processes = []
        self.scheduler = f"tcp://{self.address('hub')}:{PORT}"

    def address(self, name):
        return f"10.77.0.{self.NAMES.index(name) + 1}"

    def namespace(self, name):
        return f"{self._prefix}{name}"

    def build(self):
        """Make the namespaces; skip the test where that is not possible."""
        if os.geteuid() != 0 or shutil.which("ip") is None:
            pytest.skip("network namespaces need root and iproute2")
        try:
            for name in self.NAMES:
                self._ip("netns", "add", self.namespace(name))
        except subprocess.CalledProcessError as error:
            pytest.skip(f"no network namespaces here: {error.stderr.decode().strip()}")
        for name in self.NAMES:
            self._ip("-n", self.namespace(name), "link", "set", "dev", "lo", "up")
        hub = self.namespace("hub")
        self._ip("-n", hub, "link", "add", "name", "bridge", "type", "bridge")
        self._ip("-n", hub, "addr", "add", f"{self.address('hub')}/24", "dev", "bridge")
        self._ip("-n", hub, "link", "set", "dev", "bridge", "up")
        for name in self.NAMES[1:]:
            here = self.namespace(name)
            self._ip("-n", hub, "link", "add", "name", name, "type", "veth", "peer", "name", "eth0", "netns", here)
            self._ip("-n", hub, "link", "set", "dev", name, "master", "bridge", "up")
            self._ip("-n", here, "addr", "add", f"{self.address(name)}/24", "dev", "eth0")
            self._ip("-n", here, "link", "set", "dev", "eth0", "up")

    @staticmethod
    def _ip(*words):
        subprocess.run(["ip", *words], check=True, capture_output=True)

    def start(self, name, *command, to=None):
        """Start a program on a machine; its output goes to a file in the machine's folder."""
        folder = self.folder / name
        (folder / "tmp").mkdir(parents=True, exist_ok=True)
        told = folder / (to or f"told-{len(self.processes)}")
        with told.open("wb") as stream:
            process = subprocess.Popen(
                ["ip", "netns", "exec", self.namespace(name), *map(str, command)],
                cwd=folder,
                env=self._environment(folder) | {"XDG_CACHE_HOME": str(folder / "cache")},
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=stream,
                start_new_session=True,
            )
        process.told = told
        self.processes.append(process)
        return process

    def start_scheduler(self):
        listen = ["--host", self.address("hub"), "--port", PORT, "--no-dashboard"]
        return self.start("hub", *DASK, "scheduler", *listen)

    def start_worker(self, name, *more):
        """Start a worker that is not started again when it ends."""
        options = ["--nthreads", 1, "--no-nanny", "--no-dashboard", "--local-directory", self.folder / name / "dask"]
        return self.start(name, *DASK, "worker", self.scheduler, "--host", self.address(name), *options, *more)

    def start_other_worker(self, name, program=OTHER_VERSION):
        preload = self.folder / f"other_{name}.py"
        preload.write_text(program)
        return self.start_worker(name, "--preload", preload)

    def grade_all(self, submissions, out):
        command = [*COURSE, "grade-all", "03_teleop", submissions, "--out", out, "--dask", self.scheduler]
        return self.start("home", *command)

    def close(self):
        for process in self.processes:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, 9)
            process.wait()
        for name in self.NAMES:
            subprocess.run(["ip", "netns", "del", self.namespace(name)], capture_output=True, check=False)
