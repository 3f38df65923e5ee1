"""The command lines of processes that tests look at."""

import contextlib

import psutil


def command_of(process):
    """Return the words of its command, which exec() sets only after `Popen` has returned; none of a zombie."""
    with contextlib.suppress(psutil.Error):  # the child of another test has just ended
        while process.status() != psutil.STATUS_ZOMBIE:
            if words := process.cmdline():
                return words
    return []
