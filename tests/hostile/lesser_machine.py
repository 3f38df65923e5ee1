"""Runs a command as on a machine where Linux lacks something.

    python -I -S lesser_machine.py namespaces,landlock COMMAND...

`namespaces` may not be made (EPERM), as in a container without privileges or where a setting forbids them to ordinary
users; `landlock` is not there (ENOSYS).

Source: seccomp(2).
"""

import ctypes
import os
import struct
import sys

LOAD, EQUAL, ANY_BIT, RETURN = 0x20, 0x15, 0x45, 0x06
ALLOW, REFUSE = 0x7FFF0000, 0x00050000
EPERM, ENOSYS = 1, 38
UNSHARE, CLONE, CLONE3, SETNS, LANDLOCK = 272, 56, 435, 308, 444  # x86-64
NAMESPACES = 0x7E020080  # every CLONE_NEW... flag
NUMBER, FIRST_ARGUMENT = 0, 16  # offsets in struct seccomp_data


def step(code, value, then=0, otherwise=0):
    return struct.pack("HBBI", code, then, otherwise, value)


def refuse(number, error):
    return [step(EQUAL, number, 0, 1), step(RETURN, REFUSE | error)]


lacks, command = sys.argv[1].split(","), sys.argv[2:]
program = [step(LOAD, NUMBER)]
if "landlock" in lacks:
    program += refuse(LANDLOCK, ENOSYS)
if "namespaces" in lacks:
    program += refuse(UNSHARE, EPERM) + refuse(SETNS, EPERM) + refuse(CLONE3, ENOSYS)
    program += [step(EQUAL, CLONE, 0, 3), step(LOAD, FIRST_ARGUMENT)]
    program += [step(ANY_BIT, NAMESPACES, 0, 1), step(RETURN, REFUSE | EPERM)]
code = b"".join([*program, step(RETURN, ALLOW)])
buffer = ctypes.create_string_buffer(code, len(code))
libc = ctypes.CDLL(None, use_errno=True)
libc.prctl(38, 1, 0, 0, 0)  # PR_SET_NO_NEW_PRIVS
if libc.prctl(22, 2, struct.pack("HxxxxxxQ", len(code) // 8, ctypes.addressof(buffer)), 0, 0):  # PR_SET_SECCOMP
    sys.exit(f"seccomp: {os.strerror(ctypes.get_errno())}")
os.execv(command[0], command)
