# Memory that belongs to no process: files in memory, System V segments, a full /dev/shm.
import contextlib
import ctypes
import os

libc = ctypes.CDLL(None, use_errno=True)
for what, call in (
    ("memfd_create", lambda: libc.memfd_create(b"x", 0)),
    ("shmget", lambda: libc.shmget(0, ctypes.c_size_t(1 << 30), 0o1600)),
    ("msgget", lambda: libc.msgget(0, 0o1600)),
    ("memfd_secret", lambda: libc.syscall(447, 0)),
):
    print("held" if call() < 0 else "ESCAPED", what, flush=True)
written = 0
with contextlib.suppress(OSError), open("/dev/shm/hoard", "wb") as file:
    while written < 1 << 30:
        written += file.write(b"x" * (1 << 20))
print("held" if written <= 16 << 20 else "ESCAPED", "/dev/shm", written, flush=True)
with contextlib.suppress(OSError):
    os.unlink("/dev/shm/hoard")
