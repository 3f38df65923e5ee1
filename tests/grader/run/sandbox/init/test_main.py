"""What runs inside a box stands alone and starts quickly."""

import json
import subprocess
import sys
from pathlib import Path

from gz_course.grader.run.sandbox.init import seccomp

SANDBOX = Path(__file__).parents[5] / "grader/run/sandbox"
# Modules that take longer to import than all of ours; everybody who is graded would wait for them.
SLOW = {"typing", "json", "re", "pathlib", "socket", "signal", "contextlib", "platform", "subprocess", "dataclasses"}


def test_it_imports_nothing_of_ours_but_itself_and_nothing_slow():
    code = f"import sys; sys.path.insert(0, {str(SANDBOX)!r}); before = set(sys.modules); import init.main"
    code += "; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    ours = {name for name in loaded if name.startswith(("grader", "gz", "ros"))}
    assert ours == set()
    assert {"init.kernel", "init.namespaces"} <= loaded
    assert loaded & SLOW == set()


def filtered(code):
    """What Python prints after it has put the filter on itself."""
    program = f"""
import ctypes, json, os, socket, sys
sys.path.insert(0, {str(SANDBOX)!r})
from init import kernel, seccomp
kernel.prctl(kernel.PR_SET_NO_NEW_PRIVS, 1)
seccomp.install()
libc = ctypes.CDLL(None, use_errno=True)
def error(call):
    ctypes.set_errno(0)
    return ctypes.get_errno() if call() < 0 else 0
print(json.dumps({code}))
"""
    done = subprocess.run([sys.executable, "-I", "-S", "-c", program], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def test_the_filter_refuses_every_call_it_names_and_says_how():
    numbers = (
        "{n: error(lambda: libc.syscall(n, -1, -1, -1, -1, -1, -1)) for n in (*seccomp.REFUSED, *seccomp.MISSING)}"
    )
    answers = {int(number): error for number, error in filtered(numbers).items()}
    assert answers == dict.fromkeys(seccomp.REFUSED, 1) | dict.fromkeys(seccomp.MISSING, 38)


def test_no_lease_on_a_file_and_no_notification_but_every_other_fcntl():
    answers = filtered(
        """(lambda f: [error(lambda: libc.fcntl(f, 1024, 0)), error(lambda: libc.fcntl(f, 1, 0)),
            error(lambda: libc.fcntl(f, 1025, 0)), error(lambda: libc.fcntl(os.open("/", os.O_RDONLY), 1026, 1)),
            ])(os.open(os.__file__, os.O_RDONLY))"""
    )
    assert answers == [1, 0, 0, 1]


def test_priority_scheduling_and_limits_are_changed_of_oneself_only():
    calls = {
        "setpriority": "libc.setpriority({kind}, {who}, 1)",
        "ioprio_set": "libc.syscall(251, 1 + {kind}, {who}, 0x4000)",
        "sched_setaffinity": "libc.syscall(203, {who}, 8, bytes([1] + [0] * 7))",
        "sched_setscheduler": "libc.syscall(144, {who}, 0, bytes(8))",
        "sched_setattr": "libc.syscall(314, {who}, 0, 0)",
        "prlimit": "libc.prlimit({who}, 7, 0, 0)",
    }

    def answers(**what):
        code = ", ".join(f"{name!r}: error(lambda: {call.format(**what)})" for name, call in calls.items())
        return filtered(f"{{{code}}}")

    # What would concern another process is not done; only limits are refused with an error.
    others = answers(kind=0, who="os.getppid()")
    assert others.pop("prlimit") == 1 and set(others.values()) == {0}
    before, kept = "os.getpriority(0, os.getppid())", "os.sched_getscheduler(os.getppid())"
    code = "(lambda b: (libc.setpriority(0, os.getppid(), 9), libc.syscall(144, os.getppid(), 5, bytes(8)), "
    assert filtered(code + f"b == ({before}, {kept}))[2])(({before}, {kept}))") is True
    itself = answers(kind=0, who=0)
    assert itself.pop("sched_setattr") == 22  # no attributes
    assert set(itself.values()) == {0}


def test_the_filter_lets_ordinary_work_through():
    assert filtered("[os.getpid() > 0, os.waitpid(os.fork() or os._exit(7), 0)[1], len(os.listdir('/'))][0]") is True
    families = "[error(lambda: libc.socket(family, 1, 0)) for family in (1, 2, 10, 17, 38, 40)]"
    assert filtered(families) == [0, 0, 0, 97, 97, 97]
    protocols = "[error(lambda: libc.socket(16, 3, protocol)) for protocol in (0, 4, 9, 11, 15)]"  # of netlink
    assert filtered(protocols) == [0, 97, 97, 97, 97]
    flags = "[error(lambda: libc.syscall(56, flag | 17, 0, 0, 0, 0)) for flag in (0x10000000, 0x40000000, 0x20000000)]"
    assert filtered(flags) == [1, 1, 1]
    threads = "(lambda t: (t.start(), t.join(), t.is_alive())[2])(__import__('threading').Thread(target=int))"
    assert filtered(threads) is False
