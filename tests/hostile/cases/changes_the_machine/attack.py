"""Changes what belongs to the whole machine: its clock, its name, its settings, its log, what becomes of a crash."""

import resource
import time


def seconds(clock):
    return struct.pack("qq", *divmod(time.clock_gettime_ns(clock), 10**9))


def opened(path):
    """Whether it may be written. Nothing is."""
    return os.close(os.open(path, os.O_WRONLY)) is None


def crash():
    """Whether a process that crashes leaves its memory as a file."""
    if (child := os.fork()) == 0:
        most = resource.getrlimit(resource.RLIMIT_CORE)[1]
        resource.setrlimit(resource.RLIMIT_CORE, (most, most))
        os.abort()
    return os.WCOREDUMP(os.waitpid(child, 0)[1])


def control_group():
    os.mkdir("/sys/fs/cgroup/taken")
    return os.rmdir("/sys/fs/cgroup/taken") is None


def more_of(kind):
    most = resource.getrlimit(kind)[1]
    if most == resource.RLIM_INFINITY:
        return VICTIM
    resource.setrlimit(kind, (most + 1, most + 1))
    return resource.getrlimit(kind)[1] > most


def kernel_log():
    room = ctypes.create_string_buffer(4096)
    return call(103, 3, room, 4096) or None


attempt("sethostname", lambda: call(170, b"taken", 5) == 0 or -1)
attempt("setdomainname", lambda: call(171, b"taken", 5) == 0 or -1)
attempt("clock_settime", lambda: call(227, 0, seconds(time.CLOCK_REALTIME)) == 0 or -1)
attempt("settimeofday", lambda: call(164, struct.pack("qq", int(time.time()), 0), 0) == 0 or -1)
attempt("adjtimex", lambda: call(159, struct.pack("I", 8).ljust(208, b"\0")) >= 0 or -1)  # ADJ_ESTERROR
attempt("clock_adjtime", lambda: call(305, 0, struct.pack("I", 8).ljust(208, b"\0")) >= 0 or -1)
attempt("kernel log", kernel_log)
attempt("process accounting", lambda: call(163, 0) == 0 or -1)
attempt("ctrl-alt-del", lambda: call(169, 0xFEE1DEAD, 672274793, 0, 0) == 0 or -1)
for path in (
    *("/proc/sys/kernel/hostname", "/proc/sys/kernel/core_pattern", "/proc/sys/kernel/ns_last_pid"),
    *("/proc/sys/vm/drop_caches", "/proc/sys/fs/pipe-max-size", "/proc/sysrq-trigger", "/sys/kernel/mm/ksm/run"),
    *("/dev/mem", "/dev/kmsg", "/dev/loop-control", "/dev/kvm", "/dev/fuse", "/dev/net/tun"),
):
    if not VICTIM or os.path.exists(path):
        attempt(f"writes {path}", lambda: opened(path))
attempt("a control group", control_group)
attempt("a core file", crash)
for name in ("CORE", "NPROC", "NOFILE", "FSIZE", "MEMLOCK", "MSGQUEUE", "RTPRIO", "NICE"):
    attempt(f"a higher limit {name}", lambda: more_of(getattr(resource, f"RLIMIT_{name}")))
attempt("real-time scheduling", lambda: os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1)) is None)
attempt("locked memory", lambda: call(151, 3) == 0 and not call(152) or -1)
