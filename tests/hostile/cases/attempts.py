# Put before the text of an attack that says `uses = ["attempts"]`: attempts against every process that it can see, but
# for those of the submission. In a witness (`test_witnesses.py`) there is no wall, and they aim at a victim that it names.
import ctypes
import os
import struct

LIBC = ctypes.CDLL(None, use_errno=True)
MOST = 60  # processes that are aimed at
VICTIM = int(os.environ.get("WITNESS_VICTIM", "0"))


def attempt(what, call):
    """Try something. It has been done if it returns anything but None, False, or -1 with an errno, and raises nothing."""
    ctypes.set_errno(0)
    try:
        done = call()
        if done == -1 and ctypes.get_errno():
            raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    except Exception as error:
        done, why = None, f"{type(error).__name__} {getattr(error, 'strerror', None) or error}"
    else:
        why = "" if done not in (None, False) else "without effect"
    done = done not in (None, False)
    print(("worked" if done else "did not work") if VICTIM else ("ESCAPED" if done else "held"), what, why, flush=True)
    return done


def status_of(pid, name):
    """A line of what the kernel says about a process; empty if it says nothing."""
    try:
        with open(f"/proc/{pid}/status") as file:
            return next((line.split(":", 1)[1].strip() for line in file if line.startswith(f"{name}:")), "")
    except OSError:
        return ""


def others():
    """Processes that are not the submission's: its parent, those in /proc, and small numbers that are taken."""
    if VICTIM:
        return [VICTIM]
    mine, before = {os.getpid(), *map(int, os.listdir("/proc/self/task"))}, -1
    numbers = {int(name) for name in os.listdir("/proc") if name.isdigit()} | set(filter(is_taken, range(2, 2000)))
    while before != len(mine):
        before = len(mine)
        mine |= {n for n in numbers if status_of(n, "PPid").isdigit() and int(status_of(n, "PPid")) in mine}
    return sorted({*numbers, os.getppid(), 1} - mine - {0})[:MOST]


def is_taken(number):
    """Whether there is a process or thread of this number, to be seen or not."""
    try:
        return bool(os.sched_getaffinity(number))
    except OSError:
        return False


def call(number, *arguments):
    """The result of a system call; -1 and an errno if it is refused."""
    return LIBC.syscall(number, *(ctypes.c_long(a) if isinstance(a, int) else a for a in arguments))


def vector(address, length):
    """A struct iovec."""
    return struct.pack("PN", address, length)
