import ctypes
import os
from pathlib import Path

libc = ctypes.CDLL(None, use_errno=True)
others = [int(p.name) for p in Path("/proc").iterdir() if p.name.isdigit() and int(p.name) != os.getpid()]
print("held" if others in ([], [1]) else "ESCAPED", "processes", others, flush=True)
for pid in {1, os.getppid(), *others}:
    for name in ("environ", "mem", "maps", "fd", "cwd/", "root/", "exe"):
        path = f"/proc/{pid}/{name}"
        try:
            found = os.listdir(path) if name[-1] in "d/" else open(path, "rb").read(10)
        except OSError:
            print("held", path, flush=True)
        else:
            print("ESCAPED" if found else "held", path, found, flush=True)
    print("ESCAPED" if libc.ptrace(16, pid, 0, 0) == 0 else "held", "ptrace", pid, flush=True)
    buffer = ctypes.create_string_buffer(8)
    got = libc.process_vm_readv(pid, buffer, 0, buffer, 0, 0)
    print("ESCAPED" if got >= 0 else "held", "process_vm_readv", pid, flush=True)
    try:
        print("ESCAPED" if libc.syscall(438, os.pidfd_open(pid), 0, 0) >= 0 else "held", "pidfd_getfd", pid, flush=True)
    except OSError:
        print("held", "pidfd_open", pid, flush=True)
secrets = [word for word in open("/proc/self/mountinfo") if "solutions" in word or "exercises" in word]
print("ESCAPED" if secrets else "held", "mounts", secrets, flush=True)
