"""The first process of a run whose submission is a node with its own packages of interfaces.

Started as `python -P -m course_agent.run_package SERVER JSON`. It builds the packages beside the student's node
`SERVER` as `colcon build` does, and starts that node once the exercise's own node, which runs in another sandbox, is
ready: then `GO` can be read. The JSON object has the parameters of the student's node. The exit code is that of this
node; `BUILD_FAILED` if a package cannot be built.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

BUILD_FAILED = 2
FAULT = "[ERROR] [colcon]: "  # begins a line about a package that cannot be built
GO = "COURSE_GO"  # environment variable with the number of a pipe, which says when the node is to be started
SIMULATED_TIME = ("--ros-args", "-p", "use_sim_time:=true")


def main() -> None:
    """Build, start the node when it is to be started, and exit as it does."""
    server, given = Path(sys.argv[1]), json.loads(sys.argv[2])
    if faults := built(server.parent):
        for each in faults:
            print(f"{FAULT}{each}", file=sys.stderr, flush=True)
        sys.exit(BUILD_FAILED)
    if go := os.environ.pop(GO, ""):
        os.read(int(go), 1)  # nothing of the submission runs before the exercise's node is complete
    words = [word for name, value in given.items() for word in ("-p", f"{name}:={value}")]
    node = [sys.executable, "-P", "-m", "course_agent.run_node", str(server), *SIMULATED_TIME, *words]
    process = subprocess.Popen(node)
    try:
        code = process.wait()
    except KeyboardInterrupt:
        code = 130
    process.kill()
    if code < 0:
        signal.signal(-code, signal.SIG_DFL) if -code not in (signal.SIGKILL, signal.SIGSTOP) else None
        os.kill(os.getpid(), -code)
    sys.exit(code)


def built(folder: Path) -> list[str]:
    """Build every package below a folder, to be imported from now on; return what is wrong with them."""
    install = Path(os.environ["HOME"], "install")
    faults = build_all(folder, install)
    path = [str(install), os.environ.get("AMENT_PREFIX_PATH", "")]
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(filter(None, path))
    return faults


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
