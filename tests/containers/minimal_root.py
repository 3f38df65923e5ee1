"""A minimal Debian in a folder, made by debootstrap: Python, pip, venv, make and git.

Commands run in it by chroot, with layers on top of it (overlayfs), in a mount and process namespace of their own. The
kernel lets nobody make a user namespace in a chroot, as on machines where that is switched off.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

PACKAGES = "python3,python3-venv,python3-pip,make,git,ca-certificates"
SUITE = "bookworm"
USER = 1000
# The machine's ways to its package registries.
FROM_THE_MACHINE = ("/etc/pip.conf", "/etc/resolv.conf", "/etc/hosts", "/etc/ssl/certs/ca-certificates.crt")
_ENTER = """
set -eu
cd /  # a folder of the layers cannot be below the current one
mount -t overlay overlay -o "lowerdir=$1,upperdir=$2/upper,workdir=$2/work" "$2/merged"
root=$2/merged user=$3 network=$4; shift 4
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mount -t tmpfs tmpfs "$root/dev/shm"
chmod 1777 "$root/dev/shm"
if [ -n "${GIVEN_LAYERS:-}" ]; then
    mount -t overlay overlay -o "lowerdir=$GIVEN_LAYERS" "${root%/merged}/given"
fi
if [ -n "${GIVEN:-}" ]; then
    mkdir -p "$root/given"
    mount --bind "$GIVEN" "$root/given"
fi
[ "$network" = yes ] || ip link set lo up
exec chroot --userspec="$user:$user" "$root" "$@"
"""


def why_not() -> str:
    """Return why no root can be made here, empty if one can."""
    if os.geteuid() != 0:
        return "only root can make a minimal Debian"
    missing = [name for name in ("debootstrap", "unshare", "ip") if shutil.which(name) is None]
    return f"{missing[0]} is not installed" if missing else ""


def debian(folder: Path) -> Path:
    """Return the root in `folder`; the first of several test processes makes it. Raises CalledProcessError."""
    folder.mkdir(exist_ok=True)
    root, done = folder / "root", folder / "done"
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not done.exists():
            command = ["debootstrap", "--variant=minbase", f"--include={PACKAGES}", SUITE, str(root)]
            subprocess.run(command, check=True, capture_output=True, text=True)
            for path in map(Path, FROM_THE_MACHINE):
                if path.is_file():
                    shutil.copy(path, root / path.relative_to("/"))
            for name in ("python", "pip"):  # as the images of Docker's `python` have them
                (root / "usr/local/bin" / name).symlink_to(f"/usr/bin/{name}3")
            done.touch()
    return root


class Layer:
    """What is written on top of a root and other layers."""

    def __init__(self, folder: Path, below: Sequence[Path]) -> None:
        """Make an empty layer in `folder`; `below` begins with the uppermost."""
        for name in ("upper", "work", "merged", "given"):
            (folder / name).mkdir(parents=True)
        self.folder, self.below = folder, list(below)

    @property
    def upper(self) -> Path:
        """The files of this layer."""
        return self.folder / "upper"

    @property
    def all(self) -> list[Path]:
        """This layer and those below, as `below` of another one."""
        return [self.upper, *self.below]

    def run(
        self,
        words: Sequence[str],
        *,
        user: int = USER,
        environment: Mapping[str, str] | None = None,
        network: bool = True,
        given: Path | None = None,
        given_by: Layer | None = None,
    ) -> subprocess.CompletedProcess[str]:
        """Run a command in the root; `given` is a folder of the machine, or of another layer, that is `/given` there.

        All its processes end with it. The output is stdout and stderr together.
        """
        outside = dict(os.environ)
        if given_by is not None:
            outside["GIVEN_LAYERS"] = ":".join(map(str, given_by.all))
            given = self.folder / "given" / str(given).lstrip("/")
        if given is not None:
            outside["GIVEN"] = str(given)
        own = ["unshare", "--mount", "--pid", "--fork", "--kill-child", *([] if network else ["--net"])]
        arguments = [":".join(map(str, self.below)), str(self.folder), str(user), "yes" if network else "no"]
        kept = {name: value for name, value in os.environ.items() if name.startswith("PIP_")}
        plain = {"PATH": "/usr/local/bin:/usr/sbin:/usr/bin:/bin", "HOME": "/home/student", "LANG": "C.UTF-8"}
        inside = [f"{name}={value}" for name, value in {**kept, **plain, **(environment or {})}.items()]
        return subprocess.run(
            [*own, "sh", "-c", _ENTER, "enter", *arguments, "/usr/bin/env", "-i", *inside, *words],
            env=outside,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
