import os
import sys
from pathlib import Path


def look(path):
    try:
        found = os.listdir(path) if os.path.isdir(path) else [open(path, "rb").read(100)]
    except OSError as error:
        return print("held", path, type(error).__name__, flush=True)
    print("held" if not found else "ESCAPED", path, found[:5], flush=True)


course = Path(sys.prefix).parent
for name in ("solutions", "exercises", "tests", "chapters", ".git", "runs", "README.md", "grader/score", "grader/grade.py"):
    look(course / name)
for name in ("/etc/shadow", "/etc/ssh", "/root/.ssh", "/root/.bash_history", "/home", "/var", "/run", "/srv", "/mnt", "/boot", "/sys"):
    look(name)
for found in Path("/tmp").iterdir():
    if not course.is_relative_to(found):  # Python itself may be installed below /tmp
        print("ESCAPED", found, flush=True)
for found in {p.name for p in course.iterdir()} - {".venv", "sim", "public", "grader"} if course.is_dir() else ():
    print("ESCAPED", found, flush=True)
for found in {str(p.relative_to(course)) for p in (course / "grader").rglob("*.py")}:
    if not found.startswith(("grader/run/sandbox/init", "grader/run/agent")):
        print("ESCAPED", found, flush=True)
