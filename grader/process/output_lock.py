"""A lock that keeps two graders, started in two terminals, from writing the same recordings at once.

`grade.py` holds it while it writes. It is a lock of the kernel (flock), released when its process ends for whatever
reason.

Source: flock(2).
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gz_course.grader.errors import UsageError

NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)  # some network file systems have none


@contextmanager
def sole_writer(out: Path, exercise: str) -> Iterator[None]:
    """Hold the lock on grading this exercise into the folder `out`.

    Raises UsageError if another process holds it or the folder cannot be written.
    """
    path = out / f".{exercise}.lock"
    try:
        out.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if not os.fstat(descriptor).st_nlink:  # its former owner removed the file between our two calls
            raise BlockingIOError
    except BlockingIOError:
        os.close(descriptor)
        raise UsageError(
            f"another `course grade {exercise}` is writing into {out} right now; wait until it is done, or give "
            "another folder with --out"
        ) from None
    except OSError as error:
        if error.errno not in NO_LOCKS:
            os.close(descriptor)
            raise UsageError(f"cannot lock {path}: {error.strerror}") from None
    try:
        yield
    finally:
        with contextlib.suppress(OSError):
            path.unlink()
        os.close(descriptor)
