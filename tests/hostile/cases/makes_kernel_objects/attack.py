"""Makes what the kernel keeps beyond a run, or what sees, holds or hides more than files and processes do."""

import fcntl
import tempfile

NAMESPACES = {"mnt": 0x20000, "cgroup": 0x2000000, "uts": 0x4000000, "ipc": 0x8000000, "pid": 0x20000000, "time": 0x80}
# A struct perf_event_attr: the processor time of this process, without the kernel's.
COUNTER = struct.pack("IIQQQQQ80x", 1, 128, 0, 0, 0, 0, 0x60)


def in_a_child(act):
    """What it does to the process itself is the child's."""
    if (child := os.fork()) == 0:
        try:
            os._exit(0 if act() == 0 else 1)
        finally:
            os._exit(1)
    return os.waitpid(child, 0)[1] == 0


def watched(folder):
    with open(call(294, 0), "rb", buffering=0) as watch:
        return call(254, watch.fileno(), folder, 0x100)


def noticed(folder):
    """Be told by a signal when somebody opens a file in a folder (dnotify)."""
    place = os.open(folder, os.O_RDONLY)
    try:
        return fcntl.fcntl(place, 1026, 0x1) is not None
    finally:
        os.close(place)


def leased():
    path = os.path.join(tempfile.gettempdir(), "leased")
    with open(path, "w"):
        pass
    with open(path) as read:
        return fcntl.fcntl(read, 1024, fcntl.F_RDLCK) is not None


def segments_of_others():
    """How many segments of System V there are, whoever made them."""
    return call(31, 0, 14, ctypes.create_string_buffer(200)) >= 0 or -1


def by_handle():
    handle, where = struct.pack("Ii", 128, 0).ljust(140, b"\0"), ctypes.c_int()
    room = ctypes.create_string_buffer(handle, 140)
    if call(303, -100, b"/etc/passwd", room, ctypes.byref(where), 0):
        return -1
    return call(304, os.open("/", os.O_RDONLY), room, 0)


attempt("add_key", lambda: call(248, b"user", b"taken", b"x", 1, -3))
attempt("request_key", lambda: call(249, b"user", b"taken", 0, -3))
attempt("keyring of this session", lambda: call(250, 0, -3, 1))
attempt("keyring of another session", lambda: call(250, 1, b"taken"))
attempt("semget", lambda: call(64, 0, 1, 0o1600) >= 0 or -1)
attempt("shmctl", segments_of_others)
attempt("mq_open", lambda: call(240, b"taken", os.O_CREAT | os.O_RDWR, 0o600, 0))
attempt("mq_unlink", lambda: call(241, b"taken") == 0 or -1)
attempt("userfaultfd", lambda: call(323, 1))
attempt("io_uring_setup", lambda: call(425, 1, ctypes.create_string_buffer(120)))
attempt("perf_event_open", lambda: call(298, COUNTER, 0, -1, -1, 0))
attempt("fanotify_init", lambda: call(300, 0x200, 0))
attempt("bpf", lambda: call(321, 0, struct.pack("IIII", 2, 4, 4, 1).ljust(72, b"\0"), 72))
for folder in ("/", "/tmp"):
    attempt(f"inotify in {folder}", lambda: watched(folder.encode()))
    attempt(f"dnotify in {folder}", lambda: noticed(folder))
attempt("a lease on a file", leased)
attempt("open_by_handle_at", by_handle)
attempt("fsopen", lambda: call(430, b"tmpfs", 0))
attempt("open_tree", lambda: call(428, -100, b"/tmp", 1))
for name, flag in NAMESPACES.items():
    attempt(f"a new namespace {name}", lambda: in_a_child(lambda: call(272, flag)))
for pid in others():
    for name in ("net", "mnt", "pid", "user", "ipc"):
        attempt(f"namespace {name} of {pid}", lambda: in_a_child(lambda: call(308, os.open(f"/proc/{pid}/ns/{name}", 0), 0)))
    attempt(f"namespaces of {pid} by pidfd", lambda: in_a_child(lambda: call(308, os.pidfd_open(pid), 0x40000000)))
