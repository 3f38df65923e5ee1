"""Ends processes whose launch was killed, or whose `ros2 run` was.

`ChildProcess` registers each process group from its start to its end. While there is one, a small shell outside of the
launch's session reads the groups from a pipe. The pipe closes when the launch ends for any reason; the groups that are
still registered then get SIGINT, later SIGTERM and later SIGKILL. After a normal end none is registered, and the shell
exits at once. `ros2 run` registers its child, alone if that is in the group of a terminal's foreground.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import threading

from gz_course.sim.child_end import await_end

PATIENCE = 50  # [0.1 s] after each signal
# It reads lines `+ TARGET` and `- TARGET`, where a target is a number for kill, negative for a process group; its only
# argument is PATIENCE.
SCRIPT = """\
trap '' HUP INT QUIT TERM
groups=
while read -r change group; do
    kept=
    for each in $groups; do [ "$each" = "$group" ] || kept="$kept $each"; done
    groups=$kept
    [ "$change" = + ] && groups="$groups $group"
done
for name in INT TERM KILL; do
    for each in $groups; do kill -s $name -- "$each"; done
    left=$1
    while [ "$left" -gt 0 ]; do
        living=
        for each in $groups; do kill -s 0 -- "$each" && living="$living $each"; done
        groups=$living
        [ "$groups" ] || exit 0
        sleep 0.1
        left=$((left - 1))
    done
done
"""


class _Watch:
    """One shell for all launches of this process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._targets: set[int] = set()
        self._shell: subprocess.Popen[bytes] | None = None
        self._pipe = -1

    def add(self, target: int) -> None:
        with self._lock:
            if not self._targets:
                self._start()
            self._targets.add(target)
            self._write_line(f"+ {target}\n")

    def remove(self, target: int) -> None:
        with self._lock:
            if target not in self._targets:
                return
            self._targets.remove(target)
            self._write_line(f"- {target}\n")
            if not self._targets:
                self._end()

    def _start(self) -> None:
        read, self._pipe = os.pipe()
        try:
            self._shell = subprocess.Popen(
                ["/bin/sh", "-c", SCRIPT, "orphan_watch", str(PATIENCE)],
                stdin=read,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env={"PATH": os.defpath},
                cwd="/",
                start_new_session=True,
            )
        except OSError:  # no more processes, or no shell: a launch works without it
            self._shell = None
        finally:
            os.close(read)

    def _write_line(self, line: str) -> None:
        with contextlib.suppress(OSError):
            os.write(self._pipe, line.encode())

    def _end(self) -> None:
        os.close(self._pipe)
        self._pipe = -1
        if self._shell is not None:
            await_end(self._shell, 1.0)


_watch = _Watch()


def _forget() -> None:
    """Close the parent's pipe in a forked child, which has no process groups of its own yet."""
    global _watch
    if _watch._pipe >= 0:
        os.close(_watch._pipe)
    _watch = _Watch()


os.register_at_fork(after_in_child=_forget)


def watch(group: int) -> None:
    """End this process group if this process is killed."""
    _watch.add(-group)


def unwatch(group: int) -> None:
    """Forget a process group that has ended."""
    _watch.remove(-group)


def watch_process(pid: int) -> None:
    """End this process, but not the others of its group, if this process is killed."""
    _watch.add(pid)


def unwatch_process(pid: int) -> None:
    """Forget a process that has ended."""
    _watch.remove(pid)
