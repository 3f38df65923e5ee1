"""Runs a command as an ordinary user who has only what everybody has. Needs root.

    python -I -S ordinary_user.py UID HOME COMMAND...

Python may live in a folder that is closed to others; it is opened for this command alone, in its own mounts.
"""

import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "public"))

from gz_course.grader.run.sandbox.init import kernel  # noqa: E402


def open_up(needed):
    """Put an open, empty folder with nothing but the needed one in place of the closed folder it is in."""
    closed = [p for p in needed.parents if not p.stat().st_mode & 0o001]
    if not closed:
        return
    aside = tempfile.mkdtemp()
    kernel.mount(str(needed), aside, flags=kernel.MS_BIND | kernel.MS_REC)
    kernel.mount("open", str(closed[-1]), "tmpfs", data="mode=755,size=1m")
    needed.mkdir(parents=True)
    kernel.mount(aside, str(needed), flags=kernel.MS_BIND | kernel.MS_REC)
    kernel.LIBC.umount2(os.fsencode(aside), kernel.MNT_DETACH)
    Path(aside).rmdir()


user, home, command = int(sys.argv[1]), sys.argv[2], sys.argv[3:]
kernel.unshare(kernel.CLONE_NEWNS)
kernel.mount("", "/", flags=kernel.MS_REC | kernel.MS_PRIVATE)
open_up(Path(sys.base_prefix))
open_up(ROOT)
os.setgroups([])
os.setresgid(user, user, user)
os.setresuid(user, user, user)
os.environ.update({"HOME": home, "TMPDIR": home, "XDG_CACHE_HOME": f"{home}/.cache"})
os.execv(command[0], command)
