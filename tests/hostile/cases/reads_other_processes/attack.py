"""Reads what the kernel tells about processes that are not the submission's: memory, descriptors, environment, places."""

# A struct perf_event_attr: the processor time of a process, without the kernel's.
COUNTER = struct.pack("IIQQQQQ80x", 1, 128, 0, 0, 0, 0, 0x60)


def read(pid, name):
    path = f"/proc/{pid}/{name}"
    if os.path.isdir(path):
        return os.listdir(path) or None
    with open(path, "rb", buffering=0) as file:
        return file.read(64) or None


def read_memory(pid):
    with open(f"/proc/{pid}/maps") as maps:
        start = int(next(line for line in maps if " r" in line).split("-")[0], 16)
    with open(f"/proc/{pid}/mem", "rb", buffering=0) as memory:
        memory.seek(start)
        return memory.read(16)


def read_vector(pid):
    """The first bytes of the program, where this one has its own: addresses are only known by reading the map."""
    with open(f"/proc/{pid}/maps") as maps:
        start = int(next(line for line in maps if " r" in line).split("-")[0], 16)
    room = ctypes.create_string_buffer(16)
    return call(310, pid, vector(ctypes.addressof(room), 16), 1, vector(start, 16), 1, 0)


def robust_list(pid):
    head, length = ctypes.c_void_p(), ctypes.c_size_t()
    return call(274, pid, ctypes.byref(head), ctypes.byref(length)) == 0 or -1


def first_descriptor(pid, then):
    for number in os.listdir(f"/proc/{pid}/fd"):
        return then(number)


def taken_descriptor(pid):
    return call(438, os.pidfd_open(pid), 0, 0)


def opened_descriptor(pid):
    return first_descriptor(pid, lambda number: os.readlink(f"/proc/{pid}/fd/{number}"))


for pid in others():
    for name in ("environ", "auxv", "maps", "smaps", "numa_maps", "pagemap", "syscall", "io", "fd", "fdinfo", "map_files"):
        attempt(f"{name} of {pid}", lambda: read(pid, name))
    for name in ("cwd", "root", "exe", "ns/net"):
        attempt(f"link {name} of {pid}", lambda: os.readlink(f"/proc/{pid}/{name}"))
    for name in ("root/etc", "cwd"):
        attempt(f"folder {name} of {pid}", lambda: os.listdir(f"/proc/{pid}/{name}"))
    attempt(f"environ of thread {pid}", lambda: read(pid, f"task/{pid}/environ"))
    attempt(f"mem of {pid}", lambda: read_memory(pid))
    attempt(f"process_vm_readv of {pid}", lambda: read_vector(pid))
    attempt(f"ptrace seize of {pid}", lambda: call(101, 0x4206, pid, 0, 0) == 0 or -1)
    attempt(f"kcmp with {pid}", lambda: call(312, pid, os.getpid(), 1, 0, 0))
    attempt(f"get_robust_list of {pid}", lambda: robust_list(pid))
    attempt(f"pidfd_getfd of {pid}", lambda: taken_descriptor(pid))
    attempt(f"target of a descriptor of {pid}", lambda: opened_descriptor(pid))
    attempt(f"move_pages of {pid}", lambda: call(279, pid, 0, 0, 0, 0, 0) == 0 or -1)
    attempt(f"perf_event_open of {pid}", lambda: call(298, COUNTER, pid, -1, -1, 0))
