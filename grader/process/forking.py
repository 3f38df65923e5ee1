"""Forks of a process whose other threads, if any, are known to be at rest."""

from __future__ import annotations

import os
import warnings


def fork() -> int:
    """Do what `os.fork` does, for a caller who knows that the threads of libraries hold nothing the child needs.

    Python 3.12 and newer warn of every thread in a process that forks. The warning would appear as a line of the
    program that runs in the child.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        return os.fork()
