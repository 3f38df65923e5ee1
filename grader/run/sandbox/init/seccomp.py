"""The system calls a submission cannot make: those that reach out of a sandbox or build a new one.

A seccomp filter in classic BPF. A refused call fails with EPERM, ENOSYS or EAFNOSUPPORT; no process is killed for
trying.

Source: seccomp(2); Linux kernel documentation, "Seccomp BPF (SECure COMPuting with filters)".
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct

from .kernel import LIBC, checked

PR_SET_SECCOMP, SECCOMP_MODE_FILTER = 22, 2
AUDIT_ARCH_X86_64 = 0xC000003E
X32_BIT = 0x40000000
ALLOW, REFUSE = 0x7FFF0000, 0x00050000
LOAD, JUMP_EQUAL, JUMP_ABOVE, JUMP_ANY_BIT, RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
NUMBER, ARCHITECTURE, FIRST_ARGUMENT = 0, 4, 16  # offsets in struct seccomp_data
NAMESPACES = 0x7E020080  # every CLONE_NEW... flag
CLONE, SOCKET, SOCKETPAIR, CLONE3 = 56, 41, 53, 435
FAMILIES = (1, 2, 10, 16)  # AF_UNIX, AF_INET, AF_INET6, AF_NETLINK
NETLINK, INTERFACES = (
    16,
    0,
)  # the protocol that lists network interfaces; another tells of processes of the whole machine

# Calls refused with EPERM, by x86-64 number.
REFUSED = {
    101: "ptrace", 310: "process_vm_readv", 311: "process_vm_writev", 312: "kcmp", 438: "pidfd_getfd",
    165: "mount", 166: "umount2", 155: "pivot_root", 161: "chroot", 272: "unshare", 308: "setns",
    428: "open_tree", 429: "move_mount", 430: "fsopen", 431: "fsconfig", 432: "fsmount", 433: "fspick",
    442: "mount_setattr", 248: "add_key", 249: "request_key", 250: "keyctl", 321: "bpf", 298: "perf_event_open",
    323: "userfaultfd", 304: "open_by_handle_at", 175: "init_module", 313: "finit_module", 246: "kexec_load",
    169: "reboot", 167: "swapon", 153: "vhangup", 172: "iopl", 173: "ioperm", 300: "fanotify_init",
    254: "inotify_add_watch",  # tells the names in any folder of the same user, which Landlock does not prevent
    440: "process_madvise", 448: "process_mrelease", 256: "migrate_pages", 279: "move_pages",
}  # fmt: skip
# Calls refused with ENOSYS: memory outside all limits (memfd), what outlives a run and belongs to a user, not to a run
# (shared memory, semaphores and queues of System V, queues of POSIX), and io_uring, which bypasses this filter.
MISSING = {
    29: "shmget", 30: "shmat", 31: "shmctl", 64: "semget", 65: "semop", 66: "semctl", 220: "semtimedop",
    68: "msgget", 69: "msgsnd", 70: "msgrcv", 71: "msgctl", 240: "mq_open", 241: "mq_unlink",
    319: "memfd_create", 447: "memfd_secret",
    425: "io_uring_setup", 426: "io_uring_enter", 427: "io_uring_register", CLONE3: "clone3",
}  # fmt: skip
# Calls that change the priority or the scheduling of a process: of the calling thread only. For each number the
# arguments that are carried out, by position: which kind of id (a process), and which (0: the caller). With others the
# call does nothing and returns 0, because Fast DDS and ZeroMQ name their own threads by number, and ZeroMQ aborts if
# the call fails.
OF_ITSELF_ONLY = {
    141: {0: 0, 1: 0},  # setpriority
    251: {0: 1, 1: 0},  # ioprio_set
    203: {0: 0},  # sched_setaffinity
    142: {0: 0}, 144: {0: 0}, 314: {0: 0},  # sched_setparam, sched_setscheduler, sched_setattr
}  # fmt: skip
LIMITS_OF_ITSELF_ONLY = {302: {0: 0}}  # prlimit64; refused with EPERM for others
# Of fcntl, refused with EPERM: a lease on a file lets whoever opens it next wait; a notification (F_NOTIFY) says that
# somebody opens files in a folder.
FCNTL, OF_FILES = 72, (1024, 1026)
SECOND_ARGUMENT, THIRD_ARGUMENT = FIRST_ARGUMENT + 8, FIRST_ARGUMENT + 16


def _step(code: int, value: int, then: int = 0, otherwise: int = 0) -> bytes:
    return struct.pack("HBBI", code, then, otherwise, value)


def program() -> bytes:
    """Return the filter: an array of `struct sock_filter`."""
    no, none = _step(RETURN, REFUSE | errno.EPERM), _step(RETURN, REFUSE | errno.ENOSYS)
    yes, nothing = _step(RETURN, ALLOW), _step(RETURN, REFUSE | 0)
    other = _step(RETURN, REFUSE | errno.EAFNOSUPPORT)
    steps = [_step(LOAD, ARCHITECTURE), _step(JUMP_EQUAL, AUDIT_ARCH_X86_64, 1, 0), none]
    steps += [_step(LOAD, NUMBER), _step(JUMP_ABOVE, X32_BIT, 0, 1), none]
    for numbers, answer in ((REFUSED, no), (MISSING, none)):
        for number in numbers:
            steps += [_step(JUMP_EQUAL, number, 0, 1), answer]
    for calls, answer in ((OF_ITSELF_ONLY, nothing), (LIMITS_OF_ITSELF_ONLY, no)):
        for number, allowed in calls.items():
            steps += [_step(JUMP_EQUAL, number, 0, 3 * len(allowed) + 1)]
            for position, value in allowed.items():
                steps += [_step(LOAD, FIRST_ARGUMENT + 8 * position), _step(JUMP_EQUAL, value, 1, 0), answer]
            steps += [yes]
    steps += [_step(JUMP_EQUAL, FCNTL, 0, 2 * len(OF_FILES) + 2), _step(LOAD, SECOND_ARGUMENT)]
    for command in OF_FILES:
        steps += [_step(JUMP_EQUAL, command, 0, 1), no]
    steps += [yes]
    steps += [_step(JUMP_EQUAL, CLONE, 0, 4), _step(LOAD, FIRST_ARGUMENT)]
    steps += [_step(JUMP_ANY_BIT, NAMESPACES, 0, 1), no, yes]
    steps += [_step(JUMP_EQUAL, SOCKET, 0, 5), _step(LOAD, FIRST_ARGUMENT), _step(JUMP_EQUAL, NETLINK, 0, 3)]
    steps += [_step(LOAD, THIRD_ARGUMENT), _step(JUMP_EQUAL, INTERFACES, 1, 0), other]
    steps += [_step(LOAD, NUMBER)]
    steps += [_step(JUMP_EQUAL, SOCKET, 1, 0), _step(JUMP_EQUAL, SOCKETPAIR, 0, len(FAMILIES) + 2)]
    steps += [_step(LOAD, FIRST_ARGUMENT)]
    steps += [_step(JUMP_EQUAL, family, len(FAMILIES) - i, 0) for i, family in enumerate(FAMILIES)]
    steps += [other, yes]
    return b"".join(steps)


def supported() -> bool:
    """Return whether this kernel and machine support such filters."""
    return os.uname().machine == "x86_64" and os.path.exists("/proc/sys/kernel/seccomp/actions_avail")  # noqa: PTH110


def install() -> None:
    """Install the filter for this process and all its children, for good. Needs PR_SET_NO_NEW_PRIVS before."""
    code = program()
    buffer = ctypes.create_string_buffer(code, len(code))
    header = struct.pack("HxxxxxxQ", len(code) // 8, ctypes.addressof(buffer))
    checked(LIBC.prctl(PR_SET_SECCOMP, ctypes.c_ulong(SECCOMP_MODE_FILTER), header, 0, 0), "seccomp")
