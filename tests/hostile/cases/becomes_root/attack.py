import ctypes
import errno
import os
import subprocess

libc = ctypes.CDLL(None, use_errno=True)
me = os.getuid()
print("ESCAPED" if me == 0 else "held", "user", me, flush=True)
for what, call in (
    ("setuid", lambda: libc.setuid(0)),
    ("setgroups", lambda: libc.setgroups(0, None)),
    ("new user namespace", lambda: libc.unshare(0x10000000)),
    ("new network", lambda: libc.unshare(0x40000000)),
    ("clone with a namespace", lambda: libc.syscall(56, 0x10000000 | 17, 0, 0, 0, 0)),
    ("clone3", lambda: libc.syscall(435, 0, 0)),
    ("mount", lambda: libc.mount(b"none", b"/tmp", b"tmpfs", 0, None)),
    ("remount", lambda: libc.mount(b"none", b"/", b"", 0x1020, None)),
    ("umount", lambda: libc.umount2(b"/proc", 2)),
    ("chroot", lambda: libc.chroot(b"/tmp")),
    ("bpf", lambda: libc.syscall(321, 0, 0, 0)),
    ("keyctl", lambda: libc.syscall(250, 0, 0, 0)),
    ("io_uring", lambda: libc.syscall(425, 1, 0)),
    ("perf", lambda: libc.syscall(298, 0, 0, -1, -1, 0)),
    ("module", lambda: libc.syscall(313, -1, 0, 0)),
    ("priority", lambda: libc.setpriority(0, 0, -20)),
    ("device", lambda: libc.mknod(b"/tmp/device", 0o60666, 0x800)),
):
    ctypes.set_errno(0)
    if call() >= 0:
        print("ESCAPED", what, flush=True)
    else:
        print("held", what, errno.errorcode.get(ctypes.get_errno()), flush=True)
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
capabilities = [status[name].strip() for name in ("CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb")]
print("held" if {int(c, 16) for c in capabilities} == {0} else "ESCAPED", capabilities, flush=True)
print("held" if status["NoNewPrivs"].strip() == "1" else "ESCAPED", "privileges may grow", flush=True)
for command in (["su", "-c", "id"], ["mount", "-t", "tmpfs", "x", "/tmp"], ["unshare", "-Ur", "id"]):
    done = subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL)
    print("held" if done.returncode else "ESCAPED", command, flush=True)
