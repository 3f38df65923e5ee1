"""The first process of a run whose submission is a node with its own packages of interfaces.

Started as `python -P -m course_agent.run_package SERVER CLIENT JSON`. It builds the packages beside the student's node
`SERVER` as `colcon build` does, starts the exercise's own node `CLIENT`, and the student's when that one is ready. The
JSON object has `server`, parameters of the student's node, and `client`, which the other gets as its first argument.
All this happens in the sandbox, because texts of interfaces are of unknown origin. The exit code is that of the
student's node; `BUILD_FAILED` if a package cannot be built.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

BUILD_FAILED = 2
FAULT = "[ERROR] [colcon]: "  # begins a line about a package that cannot be built
READY = b"ready\n"  # what the exercise's node prints as soon as it takes part
SIMULATED_TIME = ("--ros-args", "-p", "use_sim_time:=true")


def main() -> None:
    """Build, start both nodes, and exit as the student's does."""
    server, client, given = Path(sys.argv[1]), Path(sys.argv[2]), json.loads(sys.argv[3])
    install = Path(os.environ["HOME"], "install")
    if faults := build_all(server.parent, install):
        for each in faults:
            print(f"{FAULT}{each}", file=sys.stderr, flush=True)
        sys.exit(BUILD_FAILED)
    path = [str(install), os.environ.get("AMENT_PREFIX_PATH", "")]
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(filter(None, path))
    clients = subprocess.Popen(_node(client, [json.dumps(given["client"])], {}), stdout=subprocess.PIPE)
    assert clients.stdout is not None
    clients.stdout.readline()  # nothing of the submission runs before the exercise's node is complete
    servers = subprocess.Popen(_node(server, [], given["server"]))
    try:
        code = servers.wait()
    except KeyboardInterrupt:
        code = 130
    for process in (clients, servers):
        process.kill()
    if code < 0:
        signal.signal(-code, signal.SIG_DFL) if -code not in (signal.SIGKILL, signal.SIGSTOP) else None
        os.kill(os.getpid(), -code)
    sys.exit(code)


def _node(file: Path, arguments: list[str], parameters: dict[str, Any]) -> list[str]:
    given = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    return [sys.executable, "-P", "-m", "course_agent.run_node", str(file), *arguments, *SIMULATED_TIME, *given]


def build_all(folder: Path, install: Path) -> list[str]:
    """Build every package below a folder; return what is wrong with them, each fault in one sentence."""
    from gz_course.sim.ros.ament_cmake.build import Package, build
    from gz_course.sim.ros.rosidl.packages import prefixes

    before = [Path(sys.prefix), *map(Path, prefixes())]
    faults = []
    for manifest in sorted(folder.glob("*/package.xml")):
        package = Package(manifest.parent, install.parent / "build" / manifest.parent.name, install)
        faults += build(package, [install, *before]).faults
    return [each.replace(f"{folder}/", "").replace("\n", " ") for each in faults]


if __name__ == "__main__":
    main()
