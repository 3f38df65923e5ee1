"""Linux calls that Python does not offer: namespaces, mounts, capabilities. Each raises OSError naming the call.

Used by the other files of this folder, in the process that becomes the sandbox.

Source: prctl(2), unshare(2), mount(2), mount_setattr(2), pivot_root(2), capset(2).
"""

from __future__ import annotations

import ctypes
import os
import struct

SIGKILL = 9

LIBC = ctypes.CDLL(None, use_errno=True)

CLONE_NEWNS = 0x00020000
CLONE_NEWUTS = 0x04000000
CLONE_NEWIPC = 0x08000000
CLONE_NEWUSER = 0x10000000
CLONE_NEWPID = 0x20000000

MS_RDONLY, MS_NOSUID, MS_NODEV, MS_NOEXEC, MS_REMOUNT = 0x1, 0x2, 0x4, 0x8, 0x20
MS_BIND, MS_REC, MS_PRIVATE, MS_SLAVE = 0x1000, 0x4000, 0x40000, 0x80000
MNT_DETACH = 2
AT_RECURSIVE, AT_FDCWD = 0x8000, -100
MOUNT_ATTR_RDONLY, MOUNT_ATTR_NOSUID, MOUNT_ATTR_NODEV = 0x1, 0x2, 0x4
SYS_PIVOT_ROOT, SYS_CAPSET, SYS_MOUNT_SETATTR = 155, 126, 442  # x86-64, the only machine with ROS wheels

PR_SET_PDEATHSIG, PR_SET_DUMPABLE, PR_CAPBSET_DROP, PR_SET_SECUREBITS = 1, 4, 24, 28
PR_SET_NO_NEW_PRIVS, PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL = 38, 47, 4
# SECBIT_NOROOT, SECBIT_NO_SETUID_FIXUP, their locks and that of SECBIT_KEEP_CAPS: see capabilities(7)
NO_ROOT = 0b101111
CAPABILITY_VERSION = 0x20080522
LAST_CAPABILITY = 63


def checked(result: int, what: str) -> int:
    """Return the result of a call. Raises OSError, with `what`, if it failed."""
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number), what)
    return result


def prctl(option: int, *arguments: int) -> int:
    padded = [ctypes.c_ulong(value) for value in (*arguments, 0, 0, 0, 0)[:4]]
    return checked(LIBC.prctl(option, *padded), f"prctl {option}")


def unshare(flags: int) -> None:
    """Move this process into new namespaces."""
    checked(LIBC.unshare(ctypes.c_int(flags)), f"unshare {flags:#x}")


def mount(source: str, target: str, kind: str = "", flags: int = 0, data: str = "") -> None:
    """Mount a file system, or bind a folder or file, at `target`."""
    checked(
        LIBC.mount(source.encode(), os.fsencode(target), kind.encode(), ctypes.c_ulong(flags), data.encode()),
        f"mount {source} on {target}",
    )


def set_host_name(name: str) -> None:
    checked(LIBC.sethostname(name.encode(), ctypes.c_size_t(len(name.encode()))), "sethostname")


def make_read_only(path: str, also_below: bool) -> None:
    """Make a mount read-only, without devices and set-user-id programs."""
    attributes = MOUNT_ATTR_RDONLY | MOUNT_ATTR_NOSUID | MOUNT_ATTR_NODEV
    wanted = ctypes.create_string_buffer(struct.pack("4Q", attributes, 0, 0, 0))
    flags = ctypes.c_uint(AT_RECURSIVE if also_below else 0)
    call = LIBC.syscall(SYS_MOUNT_SETATTR, AT_FDCWD, os.fsencode(path), flags, wanted, ctypes.c_size_t(32))
    checked(call, f"mount_setattr {path}")


def pivot_root(root: str) -> None:
    """Make a mounted folder the root of this mount namespace and detach the old root."""
    os.chdir(root)
    checked(LIBC.syscall(SYS_PIVOT_ROOT, b".", b"."), f"pivot_root {root}")
    checked(LIBC.umount2(b".", ctypes.c_int(MNT_DETACH)), "umount of the old root")
    os.chdir("/")


def drop_capabilities(user: int | None, group: int | None) -> None:
    """Switch to a user and a group (None: keep the present one) and give up all capabilities for good."""
    for number in range(LAST_CAPABILITY + 1):
        if LIBC.prctl(PR_CAPBSET_DROP, ctypes.c_ulong(number), 0, 0, 0):
            break  # not known to this kernel, or not ours to drop and so not ours to use
    LIBC.prctl(PR_SET_SECUREBITS, ctypes.c_ulong(NO_ROOT), 0, 0, 0)
    if user is not None and group is not None:
        os.setgroups([])
        os.setresgid(group, group, group)
        os.setresuid(user, user, user)
    LIBC.prctl(PR_CAP_AMBIENT, ctypes.c_ulong(PR_CAP_AMBIENT_CLEAR_ALL), 0, 0, 0)
    nothing = ctypes.create_string_buffer(bytes(24))
    checked(LIBC.syscall(SYS_CAPSET, struct.pack("Ii", CAPABILITY_VERSION, 0), nothing), "capset")
