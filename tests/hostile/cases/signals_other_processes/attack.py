"""Sends signals to processes that are not the submission's, by each way that Linux has. This one is ignored by default."""

import signal

HARMLESS = signal.SIGURG
INFO = struct.pack("iii116x", HARMLESS, 0, -1)  # a siginfo_t with SI_QUEUE


def by_pidfd(pid):
    return signal.pidfd_send_signal(os.pidfd_open(pid), HARMLESS) is None


def by_group(pid):
    group = os.getpgid(pid)  # 0 for one of another namespace; for kill that would be the own group
    return os.killpg(group, HARMLESS) is None if group else None


for pid in others():
    attempt(f"kill {pid}", lambda: os.kill(pid, HARMLESS) is None)
    attempt(f"tkill {pid}", lambda: call(200, pid, int(HARMLESS)) == 0 or -1)
    attempt(f"tgkill {pid}", lambda: call(234, pid, pid, int(HARMLESS)) == 0 or -1)
    attempt(f"rt_sigqueueinfo {pid}", lambda: call(129, pid, int(HARMLESS), INFO) == 0 or -1)
    attempt(f"rt_tgsigqueueinfo {pid}", lambda: call(297, pid, pid, int(HARMLESS), INFO) == 0 or -1)
    attempt(f"pidfd_send_signal {pid}", lambda: by_pidfd(pid))
    attempt(f"killpg {pid}", lambda: by_group(pid))
    attempt(f"signal 0 to {pid}", lambda: os.kill(pid, 0) is None)
    attempt(f"process_mrelease of {pid}", lambda: call(448, os.pidfd_open(pid), 0) == 0 or -1)
