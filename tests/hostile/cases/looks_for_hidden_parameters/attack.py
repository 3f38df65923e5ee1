"""Looks for what is hidden from students in every command line and environment: trials, seeds, names of solutions."""

import re

SECRETS = re.compile(rb"trials\.toml|expect\.toml|/solutions|seed[=\": ]|hidden_|accepts_everything")


def secret_in(pid, name):
    with open(f"/proc/{pid}/{name}", "rb") as file:
        return SECRETS.findall(file.read()) or None


for pid in sorted({*others(), *(() if VICTIM else (os.getpid(), os.getppid(), 1))}):
    for name in ("cmdline", "environ"):
        attempt(f"{name} of {pid}", lambda: secret_in(pid, name))
if not VICTIM:
    text = "\n".join(f"{name}={value}" for name, value in os.environ.items()).encode()
    attempt("the environment", lambda: SECRETS.findall(text) or None)
    with open("/proc/self/mountinfo", "rb") as mounts:
        attempt("mounts", lambda: SECRETS.findall(mounts.read()) or None)
