"""Landlock: restricts the files a process may access, and lets it signal or trace only processes in its own domain.

Needs no privilege and no namespace. Everything not allowed is refused with EACCES; files already open stay open.

Source: landlock(7); Linux kernel documentation, "Landlock: unprivileged access control".
"""

from __future__ import annotations

import ctypes
import errno
import os
import stat
import struct

from .kernel import LIBC, checked

TYPE_CHECKING = False  # importing `typing` would take longer than everything else here
if TYPE_CHECKING:
    from collections.abc import Iterable

SYS_CREATE_RULESET, SYS_ADD_RULE, SYS_RESTRICT_SELF = 444, 445, 446
VERSION, PATH_BENEATH = 1, 1
EXECUTE, WRITE_FILE, READ_FILE, READ_DIR = 1, 2, 4, 8
REFER, TRUNCATE, IOCTL_DEV = 1 << 13, 1 << 14, 1 << 15
FILES_OF_ABI = (0, (1 << 13) - 1, (1 << 14) - 1, (1 << 15) - 1, (1 << 15) - 1, (1 << 16) - 1)
OF_A_FILE = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL_DEV
TCP = 0b11  # bind and connect, from ABI 4
SCOPES = 0b11  # abstract unix sockets and signals, from ABI 6
NETWORK_ABI, SCOPE_ABI = 4, 6


def abi() -> int:
    """Return the Landlock version of this kernel; 0 if it has none or it is switched off."""
    found: int = LIBC.syscall(SYS_CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint(VERSION))
    return max(0, found)


def restrict(readable: Iterable[str], writable: Iterable[str], *, tcp: bool = True) -> None:
    """Allow this process and its children to read and execute below `readable`, and everything below `writable`.

    `tcp`: whether TCP stays allowed. Paths that do not exist are ignored. Needs PR_SET_NO_NEW_PRIVS before. Raises
    OSError if this kernel has no Landlock.
    """
    version = abi()
    if not version:
        raise OSError(errno.ENOSYS, "this kernel has no Landlock")
    every = FILES_OF_ABI[min(version, len(FILES_OF_ABI) - 1)]
    attributes = struct.pack("3Q", every, 0 if tcp or version < NETWORK_ABI else TCP, SCOPES)
    size = 24 if version >= SCOPE_ABI else 16 if version >= NETWORK_ABI else 8
    rules = checked(LIBC.syscall(SYS_CREATE_RULESET, attributes, ctypes.c_size_t(size), ctypes.c_uint(0)), "landlock")
    try:
        for path in readable:
            _allow(rules, path, every & (EXECUTE | READ_FILE | READ_DIR))
        for path in writable:
            _allow(rules, path, every)
        checked(LIBC.syscall(SYS_RESTRICT_SELF, rules, ctypes.c_uint(0)), "landlock")
    finally:
        os.close(rules)


def _allow(rules: int, path: str, rights: int) -> None:
    try:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except FileNotFoundError:
        return
    try:
        if not stat.S_ISDIR(os.fstat(place).st_mode):
            rights &= OF_A_FILE
        rule = struct.pack("=Qi", rights, place)
        checked(LIBC.syscall(SYS_ADD_RULE, rules, ctypes.c_int(PATH_BENEATH), rule, ctypes.c_uint(0)), path)
    finally:
        os.close(place)
