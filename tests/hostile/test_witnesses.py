"""What the attacks of `cases/` try works where there is no wall: else `held` would say nothing.

Each attack that `uses` `attempts` runs as it is against a victim, as root of a container of its own.
Every attempt must do what its name says there, but for those in `unproven` of its expected.toml, which this machine's
kernel cannot do, or which nobody should do to it.
"""

import os
import subprocess
import sys
import tomllib

import pytest

from gz_course.grader.run.sandbox.levels.a import program as bubblewrap

from .test_hostile import CASES, NAMES, text_of

NO_ATTACKS = True
WANTED = {name: tomllib.loads((CASES / name / "expected.toml").read_text()) for name in NAMES}
ATTEMPTS = [name for name, want in WANTED.items() if "attempts" in want.get("uses", ())]
# Starts the victim and the attack, and ends both.
WITNESS = """
import os, subprocess, sys
kinds = {{"stdout": subprocess.PIPE, "stdin": subprocess.PIPE, "env": os.environ | {{"TOLD": "/solutions/"}}}}
victim = subprocess.Popen([sys.executable, "-c", {victim!r}], start_new_session=True, **kinds)
assert victim.stdout.read(6) == b"ready\\n"
environment = os.environ | {{"WITNESS_VICTIM": str(victim.pid)}}
done = subprocess.run([sys.executable, "attack.py"], env=environment, stdin=subprocess.DEVNULL)
victim.kill()
sys.exit(done.returncode)
"""
VICTIM = """
import os, socket, sys
# What an attack may look for: seed=7 trials.toml
with open("/dev/shm/fastrtps_victim", "w") as memory:
    memory.write("shared")
door = socket.socket(socket.AF_UNIX)
door.bind("\\0victim")
door.listen()
port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for option in (socket.SO_REUSEADDR, socket.SO_REUSEPORT):
    port.setsockopt(socket.SOL_SOCKET, option, 1)
port.bind(("127.0.0.1", 7_999))
os.write(1, b"ready\\n")
sys.stdin.read()
"""


@pytest.mark.skipif(os.getuid() != 0, reason="only root has every right")
@pytest.mark.skipif(not bubblewrap(), reason="there is no bubblewrap")
@pytest.mark.parametrize("case", ATTEMPTS)
def test_an_attempt_works_where_nothing_stands_in_its_way(case, tmp_path):
    (tmp_path / "attack.py").write_text(text_of(case, WANTED[case]))
    (tmp_path / "witness.py").write_text(WITNESS.format(victim=VICTIM))
    words = [str(bubblewrap()), "--die-with-parent", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--unshare-net"]
    words += ["--ro-bind", "/", "/", "--dev-bind", "/dev", "/dev", "--bind", "/sys", "/sys", "--proc", "/proc"]
    words += [
        "--tmpfs",
        "/dev/shm",
        "--tmpfs",
        "/tmp",
        "--ro-bind",  # the checkout, or its Python, may lie in there
        sys.prefix,
        sys.prefix,
        "--bind",
        str(tmp_path),
        str(tmp_path),
        "--chdir",
        str(tmp_path),
    ]
    words += ["--", sys.executable, "witness.py"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=600)
    lines = done.stdout.splitlines()
    unproven = WANTED[case].get("unproven", ())
    failed = [line for line in lines if line.startswith("did not work") and not any(word in line for word in unproven)]
    assert not failed and sum(line.startswith("worked") for line in lines) >= 1, "\n".join([*lines, done.stderr])
