"""Types into the terminal of whoever has started the grading, or takes it away: what is typed there is run outside."""

import fcntl
import termios

TIOCLINUX = 0x541C


def on(path, act):
    terminal = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        return act(terminal)
    finally:
        os.close(terminal)


def typed(terminal):
    return fcntl.ioctl(terminal, termios.TIOCSTI, b" ") is not None


def resized(terminal):
    size = fcntl.ioctl(terminal, termios.TIOCGWINSZ, bytes(8))
    return fcntl.ioctl(terminal, termios.TIOCSWINSZ, size) is not None


def read(terminal):
    """Whether what is typed would be read: nothing is there."""
    try:
        return os.read(terminal, 1) is not None
    except BlockingIOError:
        return True


def written(terminal):
    return os.write(terminal, b"\x1b]0;taken\x07")


if VICTIM:  # it gets a terminal of its own
    master, slave = os.openpty()
    os.setsid()
    fcntl.ioctl(slave, termios.TIOCSCTTY, 0)
    terminals = [os.ttyname(slave), "/dev/tty"]
else:
    terminals = [f"/dev/{name}" for name in ("tty", "console", "tty0", "tty1", "pts/0", "pts/1", "pts/2")]
for path in terminals:
    for act in (typed, resized, read, written):
        attempt(f"{path}: {act.__name__}", lambda: on(path, act))
for number in range(3) if not VICTIM else ():
    attempt(f"descriptor {number}: typed", lambda: os.isatty(number) and typed(number))
    attempt(f"descriptor {number}: taken", lambda: os.isatty(number) and fcntl.ioctl(number, termios.TIOCSCTTY, 1))
