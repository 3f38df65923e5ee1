"""Reads and changes the shared memory of others, and makes that of Fast DDS in the names that others would use, for a moment."""

from pathlib import Path

SHARED = Path("/dev/shm")


def changed(path):
    """Whether it may be written; it stays as it is."""
    return os.close(os.open(path, os.O_RDWR)) is None


def squatted(name):
    with open(SHARED / name, "xb") as file:
        return file.write(b"\xff" * 4096)


def seen():
    return [each for each in SHARED.iterdir() if each.stat().st_uid != os.getuid() or "fastrtps" in each.name]


theirs = []
if VICTIM:
    theirs = [SHARED / "fastrtps_victim"]
else:
    attempt("what others have in shared memory", lambda: theirs.extend(seen()))
for pid in others():
    attempt(f"/dev/shm as {pid} sees it", lambda: os.listdir(f"/proc/{pid}/root/dev/shm"))
attempt("shared memory of others", lambda: [path.name for path in theirs if changed(path)] or None)
attempt("its removal", lambda: [path.name for path in theirs if path.unlink() is None] or None)
if not VICTIM:  # nobody else may see these, or wait for their locks
    domain = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"])
    names = [f"{kind}fastrtps_port{domain + k}{end}" for k in range(10, 30) for kind, end in (("", ""), ("", "_el"), ("sem.", "_mutex"))]
    made = []
    for name in names:
        try:
            made.append(squatted(name) and name)
        except OSError:
            pass
    for name in made:
        (SHARED / name).unlink()
    print("held", len(made), "of", len(names), "names could be taken in what it sees", flush=True)
