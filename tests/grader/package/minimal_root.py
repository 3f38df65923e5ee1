"""A minimal Debian in a folder, and programs that run in it as in a container of their own."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

INCLUDE = "python3,python3-venv,python3-pip,ca-certificates"
SUITE = "bookworm"
# What Docker leaves to root. Source: Docker, "Linux kernel capabilities".
DOCKER = (
    "chown,dac_override,fowner,fsetid,kill,setgid,setuid,setpcap,net_bind_service,net_raw,sys_chroot,mknod,audit_write,"
    "setfcap"
)
# A mount namespace of its own with the folder as its root, and a process namespace that ends with the command.
PIVOT = """
set -e
mount --make-rprivate / && mount --bind "$1" "$1" && cd "$1"
mount -t proc proc proc && mount --rbind /dev dev && mount -t tmpfs tmpfs dev/shm
pivot_root . mnt && umount -l mnt && cd /
shift; exec "$@"
"""
# The same with a folder that is no mount, where the kernel refuses user namespaces and every mount of the sandbox.
CHROOT = """
set -e
mount --make-rprivate /
mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" && mount -t tmpfs tmpfs "$1/dev/shm"
root=$1; shift; exec chroot "$root" setpriv --bounding-set "-all,RIGHTS" "$@"
"""
HERE = ("/etc/resolv.conf", "/etc/pip.conf", "/etc/ssl/certs/ca-certificates.crt")


class MinimalRoot:
    """The folder of the system. `run` runs a command in it as root."""

    def __init__(self, folder: Path):
        self.folder = folder
        for each in map(Path, HERE):
            if each.is_file():
                (folder / each.relative_to("/")).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(each, folder / each.relative_to("/"))

    def run(self, *command, contained=False, timeout=600):
        """Run a command to its end; `contained`: only with what Docker leaves to root."""
        kept = [
            f"{name}={value}" for name, value in os.environ.items() if name.startswith(("PIP_", "SSL_", "REQUESTS_"))
        ]
        path = "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
        script = CHROOT.replace("RIGHTS", ",".join(f"+{each}" for each in DOCKER.split(","))) if contained else PIVOT
        start = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c", script, "_", str(self.folder)]
        clean = ["env", "-i", "HOME=/root", "LANG=C.UTF-8", path, *kept]
        return subprocess.run([*start, *clean, *command], capture_output=True, text=True, timeout=timeout, check=False)


def make(folder: Path) -> MinimalRoot:
    """Unpack or make a minimal Debian; skip the test where that does not work here.

    COURSE_MINIMAL_ROOT names a tar of one, which spares the download.
    """
    if os.geteuid() != 0:
        pytest.skip("only root can enter a root file system of its own")
    if tar := os.environ.get("COURSE_MINIMAL_ROOT"):
        command = ["tar", "-C", str(folder), "-xf", tar]
    elif shutil.which("debootstrap") is None:
        pytest.skip("debootstrap is not installed")
    else:
        command = ["debootstrap", "--variant=minbase", f"--include={INCLUDE}", SUITE, str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=1800, check=False)
    if done.returncode:
        pytest.skip(f"no minimal Debian: {(done.stdout + done.stderr).strip().rpartition(chr(10))[2]}")
    root = MinimalRoot(folder)
    entered = root.run("true")
    if entered.returncode:
        pytest.skip(f"a root file system of its own cannot be entered: {entered.stderr.strip()}")
    return root
