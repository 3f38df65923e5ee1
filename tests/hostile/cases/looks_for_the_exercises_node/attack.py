"""Looks for the exercise's own node in /proc, in its files and at its sockets: for its orders, and for a way in."""

import ctypes
import os
import signal
import socket
from pathlib import Path

ORDERS = b"waypoints"  # stands in every order


def above():
    """This process and those above it."""
    found, pid = {os.getpid()}, os.getpid()
    while pid > 1:
        try:
            pid = int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
        except OSError:
            break
        found.add(pid)
    return found


def outcome(escaped, *what):
    print("ESCAPED" if escaped else "held", *what, flush=True)


def look_at(pid):
    libc = ctypes.CDLL(None, use_errno=True)
    for name in ("cmdline", "environ"):
        try:
            outcome(ORDERS in Path(f"/proc/{pid}/{name}").read_bytes(), name)
        except OSError:
            outcome(False, name)
    for name in ("mem", "maps", "fd", "root/", "cwd/"):
        try:
            path = f"/proc/{pid}/{name}"
            outcome(os.listdir(path) if name[-1] in "d/" else open(path, "rb").read(1), name)
        except OSError:
            outcome(False, name)
    buffer = ctypes.create_string_buffer(8)
    outcome(libc.ptrace(16, pid, 0, 0) == 0, "ptrace")
    outcome(libc.process_vm_readv(pid, buffer, 0, buffer, 0, 0) >= 0, "process_vm_readv")
    for number in (signal.SIGSTOP, signal.SIGKILL):
        try:
            os.kill(pid, number)
            outcome(True, "signal", number)
        except OSError:
            outcome(False, "signal", number)


def look():
    mine = above()
    numbers = sorted(int(p.name) for p in Path("/proc").iterdir() if p.name.isdigit())
    named = []
    for pid in (each for each in numbers if each not in mine):
        try:
            if b"run_exercise_node" in Path(f"/proc/{pid}/cmdline").read_bytes():
                named.append(pid)
        except OSError:
            pass
    outcome(False, "looked at", len(numbers), "processes, of which are its:", len(named))
    for pid in named:
        look_at(pid)
    for root in {Path("/tmp"), Path("/grader"), *Path(os.environ["HOME"]).parents[1:2]}:
        for pattern in ("**/given_node.py", "*/submission/.exercise/*"):
            try:
                found = [path for path in root.glob(pattern) if b"Dispatcher" in path.read_bytes()]
            except OSError:
                found = []
            outcome(found, "its files", found)
        try:
            doors = [path for path in root.glob("**/participants") if str(path) != os.environ["COURSE_SOCKET"]]
        except OSError:
            doors = []
        for path in doors:
            with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as door:
                try:
                    door.connect(str(path))
                    outcome(door.recv(10), "its socket", path)
                except OSError:
                    outcome(False, "its socket", path)


def attacked(on_goal):
    def on_goal_of_the_attack(node, goal):
        if goal.speed == 0.0:
            look()
        return on_goal(node, goal)

    return on_goal_of_the_attack
