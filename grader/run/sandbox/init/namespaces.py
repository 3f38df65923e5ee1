"""A sandbox built from namespaces by Python alone: its files are mounted in a new folder, which becomes the root.

Called by `main.py` at level B; at level A bubblewrap has done the same before.

Source: namespaces(7), user_namespaces(7), pivot_root(2).
"""

from __future__ import annotations

import os

from . import kernel

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

HERE = kernel.MS_NOSUID | kernel.MS_NODEV


def build(root: str, host: str, places: list[dict[str, Any]]) -> None:
    """Return inside the sandbox as its process 1; the calling process waits for it and ends with it.

    `root` is an empty folder to build in, `host` the host name inside, `places` come from `view.py`. Raises OSError if
    a step fails.
    """
    user, group = os.geteuid(), os.getegid()
    spaces = kernel.CLONE_NEWNS | kernel.CLONE_NEWPID | kernel.CLONE_NEWIPC | kernel.CLONE_NEWUTS
    if user:
        kernel.unshare(spaces | kernel.CLONE_NEWUSER)
        for name, text in (("setgroups", "deny"), ("uid_map", f"{user} {user} 1"), ("gid_map", f"{group} {group} 1")):
            with open(f"/proc/self/{name}", "w") as file:  # noqa: PTH123
                file.write(text)
    else:
        kernel.unshare(spaces)
    kernel.prctl(kernel.PR_SET_PDEATHSIG, kernel.SIGKILL)
    first = os.fork()
    if first:
        os.closerange(0, 65536)  # keep nothing open, so that readers see the end of file when the sandbox ends
        os.waitpid(first, 0)
        os._exit(0)
    kernel.prctl(kernel.PR_SET_PDEATHSIG, kernel.SIGKILL)
    kernel.set_host_name(host)
    kernel.mount("", "/", flags=kernel.MS_REC | kernel.MS_PRIVATE)
    kernel.mount("box", root, "tmpfs", HERE, "size=1m,nr_inodes=4000,mode=755")
    masks = [place for place in places if place["kind"] == "mask"]
    os.umask(0o022)
    for place in places:
        _put(root, place)
    for path in [*(root + place["path"] for place in masks), root]:
        kernel.make_read_only(path, also_below=False)
    kernel.pivot_root(root)


def _put(root: str, place: dict[str, Any]) -> None:
    """Create one place of the sandbox; everything but its tmpfs is read-only."""
    target = root + place["path"]
    kind, source = place["kind"], place["source"]
    if kind == "link":
        os.symlink(source, target)  # noqa: PTH211
        return
    if kind == "device" or (kind == "bind" and not os.path.isdir(source)):  # noqa: PTH112
        if not os.path.exists(target):  # noqa: PTH110
            os.close(os.open(target, os.O_CREAT | os.O_WRONLY, 0o644))
    elif not os.path.isdir(target):  # noqa: PTH112
        os.mkdir(target, 0o755)  # noqa: PTH102
    if kind == "bind":
        kernel.mount(source, target, flags=kernel.MS_BIND | kernel.MS_REC)
        kernel.make_read_only(target, also_below=True)
    elif kind == "device":
        kernel.mount(source, target, flags=kernel.MS_BIND)
    elif kind == "proc":
        kernel.mount("proc", target, "proc", HERE | kernel.MS_NOEXEC)
        hide_processes(target)
    elif kind == "mask":
        kernel.mount("mask", target, "tmpfs", HERE, "size=1m,nr_inodes=100,mode=755")
    elif kind == "tmpfs":
        kernel.mount("tmpfs", target, "tmpfs", HERE, tmpfs_limits(place))


def tmpfs_limits(place: dict[str, Any]) -> str:
    """Return the mount options of a tmpfs that every user in the sandbox may write to."""
    return f"size={place['size']},nr_inodes={place['files']},mode=1777"


def hide_processes(proc: str) -> None:
    """Let /proc show no process that its reader may not trace, such as process 1, where Linux allows that."""
    try:  # noqa: SIM105 - contextlib takes its time
        kernel.mount("proc", proc, "proc", kernel.MS_REMOUNT | HERE | kernel.MS_NOEXEC, "hidepid=2")
    except OSError:
        pass  # nothing that matters can be read there anyway


def restrict_mounts(places: list[dict[str, Any]]) -> None:
    """Limit the number of files of each tmpfs that bubblewrap has mounted, and what /proc shows."""
    hide_processes("/proc")
    for place in places:
        if place["kind"] == "tmpfs":
            kernel.mount("tmpfs", place["path"], "tmpfs", kernel.MS_REMOUNT | HERE, tmpfs_limits(place))
