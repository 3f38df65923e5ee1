"""The process from which `WarmPopen` takes its children: it has imported what commands import, and forks for each one.

Run as `python -P zygote.py DESCRIPTOR MODULE ...`. It tells what a command must have in common with it (`Common`), then
waits for commands. A child is made with CLONE_PARENT: its parent is the process that has started the zygote. It takes
over everything in which a new process would differ (descriptors, environment, signals, session, folder, `sys`, the
command line that /proc shows) and then runs as `python` would. Nothing here starts threads or opens files; the two
threads of lttng, which come with rclpy and wait for a tracer, are left behind by the fork.

Source: clone(2), PR_SET_MM in prctl(2); Python/pylifecycle.c (create_stdio) and Modules/main.c of CPython
"""

import array
import atexit
import builtins
import ctypes
import faulthandler
import gc
import importlib
import importlib.machinery
import io
import os
import pickle
import runpy
import signal
import socket
import sys
import threading
import time
import types
from pathlib import Path

NOTHING = 0xFFFFFFFF  # no descriptor
LARGEST = 200_000  # [bytes] of a command, with its environment
CLONE_PARENT, CLONE_CHILD_CLEARTID, CLONE_CHILD_SETTID = 0x8000, 0x200000, 0x1000000
SYS_CLONE, SYS_SET_ROBUST_LIST, SYS_GET_ROBUST_LIST = 56, 273, 274  # of x86-64
PR_SET_NAME, PR_SET_MM, PR_SET_MM_MAP, PR_GET_TID_ADDRESS = 15, 35, 14, 40
NEEDED_AT_THE_END = {
    "__main__",
    "_io",
    "atexit",
    "builtins",
    "codecs",
    "encodings",
    "io",
    "sys",
    "threading",
    "warnings",
}
kernel = ctypes.PyDLL(None, use_errno=True)  # keeps the interpreter's lock, also while it forks


class Memory(ctypes.Structure):
    """`struct prctl_mm_map`: where /proc finds the parts of a process."""

    _fields_ = [
        *((name, ctypes.c_uint64) for name in ("start_code", "end_code", "start_data", "end_data", "start_brk", "brk")),
        *((name, ctypes.c_uint64) for name in ("start_stack", "arg_start", "arg_end", "env_start", "env_end", "auxv")),
        *((name, ctypes.c_uint32) for name in ("auxv_size", "exe_fd")),
    ]


asked = set()


class Recorded(os._Environ):
    """The environment while modules are imported: what they ask for is kept in `asked`."""

    def __getitem__(self, name):
        asked.add(name)
        return super().__getitem__(name)


def leave_in_place(names):
    """Let Python not take apart, at its end, modules of others that it has not loaded itself: that costs most of it."""
    for name in names & sys.modules.keys():
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(sys.modules.pop(name)))


def check(result):
    if result < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return result


def load(modules):
    """Import modules; return the names of the environment variables that were asked for meanwhile."""
    plain = type(os.environ)
    os.environ.__class__ = Recorded
    for name in modules:
        importlib.import_module(name)
    os.environ.__class__ = plain
    opened = [each for each in Path("/proc/self/fd").iterdir() if each.exists()]
    if len(opened) > 4 or threading.active_count() > 1:
        raise RuntimeError(f"the modules {modules} open files or start threads: they cannot be shared")
    gc.collect()
    gc.freeze()  # a collection in a child does not copy all that it shares
    return sorted(asked)


def at_rest():
    """Wait until the threads of lttng wait: at work they could hold a lock that the child would never get."""
    for task in Path("/proc/self/task").iterdir():
        while task.name != str(os.getpid()) and fields(task)[3] != "S":
            time.sleep(0.001)


def fields(process):
    """Return the fields of `/proc/PID/stat`, numbered as in proc(5)."""
    return [None, None, None, *(process / "stat").read_text().rpartition(")")[2].split()]


def fork():
    """Return the process's number, 0 in the child, as `os.fork` does; the child is a child of our parent."""
    own = ctypes.c_uint64()  # where the C library keeps the number of this thread
    check(kernel.prctl(PR_GET_TID_ADDRESS, ctypes.byref(own), 0, 0, 0))
    head, size = ctypes.c_uint64(), ctypes.c_size_t()
    check(kernel.syscall(SYS_GET_ROBUST_LIST, 0, ctypes.byref(head), ctypes.byref(size)))
    flags = CLONE_PARENT | CLONE_CHILD_CLEARTID | CLONE_CHILD_SETTID | signal.SIGCHLD
    ctypes.pythonapi.PyOS_BeforeFork()
    pid = kernel.syscall(SYS_CLONE, ctypes.c_ulong(flags), None, None, ctypes.c_void_p(own.value), None)
    if pid:
        ctypes.pythonapi.PyOS_AfterFork_Parent()
        return check(pid)
    ctypes.pythonapi.PyOS_AfterFork_Child()
    kernel.syscall(SYS_SET_ROBUST_LIST, ctypes.c_void_p(head.value), size)
    return 0


def next_command(channel):
    """Wait for a command; fork, and return it with its descriptors in the child. Without commands, end."""
    room = socket.CMSG_SPACE(4 * array.array("i").itemsize)
    while True:
        data, received, _, _ = channel.recvmsg(LARGEST, room)
        descriptors = array.array("i", b"".join(content for _, _, content in received)).tolist()
        if not data:
            os._exit(0)
        at_rest()
        if fork() == 0:
            return pickle.loads(data), descriptors
        for each in descriptors:
            os.close(each)


def become(command, descriptors, channel):
    """Take over what a command brings along, then say so: its owner may send it a signal from now on."""
    if command["new_session"]:
        os.setsid()
    elif command["process_group"] >= 0:
        os.setpgid(0, command["process_group"])
    os.umask(command["umask"])
    os.fchdir(descriptors[3])
    set_environment(command["environment"])
    shared = {name for name in sys.modules if name.partition(".")[0] not in NEEDED_AT_THE_END}
    atexit.register(leave_in_place, shared)
    kernel.prctl(PR_SET_NAME, os.fsencode(command["title"]), 0, 0, 0)
    show([os.fsencode(each) for each in command["shown"]], os.environb)
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        signal.signal(number, signal.SIG_IGN if number in command["ignored"] else signal.SIG_DFL)
    for number in (signal.SIGPIPE, signal.SIGXFSZ):
        signal.signal(number, signal.SIG_IGN)
    if signal.SIGINT not in command["ignored"]:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    channel.send(b"%d" % os.getpid())
    for number, each in enumerate(descriptors[:3]):
        os.dup2(each, number)
    os.closerange(3, os.sysconf("SC_OPEN_MAX"))
    set_streams()
    if os.environ.get("PYTHONFAULTHANDLER"):
        faulthandler.enable()
    set_up_python(command)


def set_environment(environment):
    os.environb.clear()
    os.environb.update(environment)
    from gz_course.sim.ros.prefix import local_setup  # what the `.pth` file of the course does at every start

    local_setup.main()


def show(arguments, environment):
    """Have /proc show these arguments and this environment."""
    global shown
    first = b"".join(each + b"\0" for each in arguments)
    second = b"".join(name + b"=" + value + b"\0" for name, value in environment.items())
    shown = ctypes.create_string_buffer(first + second)
    start = ctypes.addressof(shown)
    numbers = fields(Path("/proc/self"))
    code, data, stack, brk = numbers[26:28], numbers[45:47], numbers[28], numbers[47]
    kernel.sbrk.restype = ctypes.c_void_p
    places = [*map(int, [*code, *data, brk]), kernel.sbrk(0), int(stack), start, *[start + len(first)] * 2]
    memory = Memory(*places, start + len(first + second), 0, 0, NOTHING)
    check(kernel.prctl(PR_SET_MM, PR_SET_MM_MAP, ctypes.byref(memory), ctypes.c_ulong(ctypes.sizeof(memory)), 0))


def set_streams():
    """Open standard input, output and error, buffered as at the start of Python."""
    unbuffered = bool(os.environ.get("PYTHONUNBUFFERED"))
    if unbuffered:
        for name in ("stdin", "stdout", "stderr"):
            kernel.setvbuf(ctypes.c_void_p.in_dll(kernel, name), None, 2, 0)
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        raw = unbuffered and mode == "w"
        binary = open(number, f"{mode}b", 0 if raw else -1, closefd=False)  # noqa: SIM115 - it stays open
        (binary if raw else binary.raw).name = f"<{name}>"
        old = getattr(sys, name)
        by_line = not unbuffered and (number == 2 or binary.isatty())
        stream = io.TextIOWrapper(binary, old.encoding, old.errors, "\n", by_line, write_through=unbuffered)
        stream.mode = mode
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)


def set_up_python(command):
    """Leave what a new Python finds in `sys`, and random numbers that are its own."""
    sys.executable, sys.argv, sys.orig_argv = command["executable"], command["argv"], command["shown"]
    sys.path[:0] = command["path"]
    main = types.ModuleType("__main__")
    main.__dict__.update(__builtins__=builtins, __annotations__={}, __loader__=importlib.machinery.BuiltinImporter)
    sys.modules["__main__"] = main
    threading.main_thread()._set_native_id()
    if "numpy.random" in sys.modules:
        sys.modules["numpy.random"].seed()


def run(kind, what, blocked):
    """Run a module, a script or a text as `__main__`."""
    signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
    if kind == "-m":
        if not hasattr(sys.modules.get(what), "__path__"):
            sys.modules.pop(what, None)  # the module itself is loaded as `__main__`
        runpy._run_module_as_main(what)
        return
    main = sys.modules["__main__"].__dict__
    if kind == "-c":
        exec(compile(what, "<string>", "exec"), main)
        return
    main.update(__file__=what, __cached__=None, __loader__=importlib.machinery.SourceFileLoader("__main__", what))
    with io.open_code(what) as file:
        code = compile(file.read(), what, "exec")
    exec(code, main)


def without_our_frames(error):
    """Show what a traceback shows where nothing is below the program."""
    hook, inner = sys.excepthook, error.__traceback__
    while inner and inner.tb_frame.f_code.co_filename == __file__:
        inner = inner.tb_next

    def show_error(kind, value, _):
        hook(kind, value.with_traceback(inner), inner)

    sys.excepthook = show_error


def serve(channel, modules):
    """Return in a child, with its command, when it is ready to be run."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for those whom we serve
    try:
        asked = load(modules)
        show([os.fsencode(each) for each in sys.orig_argv], os.environb)
        names = {name.partition(".")[0] for name in sys.modules} - {"__main__"}
        channel.send(pickle.dumps({"asked": asked, "names": names}))
    except Exception as error:
        channel.send(pickle.dumps({"error": f"{type(error).__name__}: {error}"}))
        os._exit(1)
    signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals() - {signal.SIGTERM})
    command, descriptors = next_command(channel)
    try:
        become(command, descriptors, channel)
    except BaseException as error:
        channel.send(f"{type(error).__name__}: {error}".encode())
        os._exit(1)
    return command["kind"], command["what"], command["blocked"]


if __name__ == "__main__":
    task = serve(socket.socket(fileno=int(sys.argv[1])), sys.argv[2:])
    try:
        run(*task)
    except SystemExit:
        raise
    except BaseException as error:
        without_our_frames(error)
        raise
