import os
import sys
from pathlib import Path


def look(path):
    try:
        found = os.listdir(path) if os.path.isdir(path) else [open(path, "rb").read(100)]
    except OSError as error:
        return print("held", path, type(error).__name__, flush=True)
    print("held" if not found else "ESCAPED", path, found[:5], flush=True)


def inside(folder):
    try:
        return list(folder.iterdir())
    except OSError as error:
        print("held", folder, type(error).__name__, flush=True)
        return []


course = Path(sys.prefix).parent
for name in ("solutions", "exercises", "tests", "chapters", ".git", "runs", "README.md", "grader/score", "grader/grade.py"):
    look(course / name)
for name in ("/etc/shadow", "/etc/ssh", "/root/.ssh", "/root/.bash_history", "/home", "/var", "/run", "/srv", "/mnt", "/boot", "/sys"):
    look(name)
for found in inside(Path("/tmp")):
    if not course.is_relative_to(found):  # Python itself may be installed below /tmp
        print("ESCAPED", found, flush=True)
for found in {p.name for p in inside(course)} - {".venv", "sim", "public", "grader"}:
    print("ESCAPED", found, flush=True)
for found in {str(p.relative_to(course)) for p in (course / "grader").rglob("*.py")}:
    if not found.startswith(("grader/run/sandbox/init", "grader/run/agent")):
        print("ESCAPED", found, flush=True)
