"""Writes into processes that are not the submission's: their memory, their descriptors, what the kernel keeps of them."""

from pathlib import Path


def place(pid):
    """An address that can be written."""
    with open(f"/proc/{pid}/maps") as maps:
        return int(next(line for line in maps if " rw" in line).split("-")[0], 16)


def through_mem(pid):
    with open(f"/proc/{pid}/mem", "r+b", buffering=0) as memory:
        memory.seek(place(pid))
        byte = memory.read(1)
        memory.seek(place(pid))
        return memory.write(byte)  # as it was: the effect is the right to do it


def through_vector(pid):
    room = ctypes.create_string_buffer(1)
    there = vector(place(pid), 1)
    here = vector(ctypes.addressof(room), 1)
    return call(310, pid, here, 1, there, 1, 0) == 1 and call(311, pid, here, 1, there, 1, 0)


def through_ptrace(pid):
    if call(101, 16, pid, 0, 0):  # PTRACE_ATTACH
        return -1
    os.waitpid(pid, 0x40000000) if VICTIM else None
    return call(101, 17, pid, 0, 0) == 0 or -1  # PTRACE_DETACH


def through_descriptor(pid):
    return os.close(os.open(f"/proc/{pid}/fd/0", os.O_WRONLY | os.O_NONBLOCK)) is None


def setting(pid, name, text):
    path = Path(f"/proc/{pid}/{name}")
    return path.write_text(text) if text else path.write_text(path.read_text().strip())


def advice(pid):
    """Ask the kernel to take pages of another process out of memory."""
    return call(440, os.pidfd_open(pid), vector(place(pid) & ~4095, 4096), 1, 20, 0)  # MADV_COLD


def limit(pid):
    import resource

    return resource.prlimit(pid, resource.RLIMIT_NOFILE, resource.prlimit(pid, resource.RLIMIT_NOFILE)) is None


for pid in others():
    attempt(f"mem of {pid}", lambda: through_mem(pid))
    attempt(f"process_vm_writev into {pid}", lambda: through_vector(pid))
    attempt(f"ptrace attach to {pid}", lambda: through_ptrace(pid))
    attempt(f"descriptor of {pid}", lambda: through_descriptor(pid))
    attempt(f"process_madvise of {pid}", lambda: advice(pid))
    attempt(f"migrate_pages of {pid}", lambda: call(256, pid, 64, struct.pack("Q", 1), struct.pack("Q", 1)) == 0 or -1)
    for name, text in (
        ("oom_score_adj", "1000"),
        ("coredump_filter", "0x3f"),
        ("clear_refs", "1"),
        ("timerslack_ns", "1000000000"),
    ):
        attempt(f"{name} of {pid}", lambda: setting(pid, name, text))
