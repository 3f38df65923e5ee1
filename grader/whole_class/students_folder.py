"""The name of a student's folder: safe on every file system, stable, and nobody else's."""

from __future__ import annotations

import hashlib
import re
import unicodedata

LONGEST = 80  # [bytes]
PART = ".part-"  # before the name of a folder that is being written
# Names that mean devices on Windows, with any suffix, and names of files beside the folders.
# Source: https://learn.microsoft.com/windows/win32/fileio/naming-a-file
RESERVED = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in "0123456789¹²³")}
# Which may be in the folder of a class before its first run: of `course similar`, and of the instructor.
BESIDE = {"similarity.csv", "similarity.html", "overrides.csv", "class.toml"}
ATTEMPTS = "attempts"  # the folder with the earlier attempts
TAKEN = {ATTEMPTS, "gradebook.csv", "journal.jsonl", "index.html", *BESIDE}
HASHED = re.compile(r"-[0-9a-f]{8}$")  # a student whose name ends as the others' folders do gets a hash, too


def folder_name(student: str) -> str:
    """Return a name for a student's folder: the student's own where it is plain, else with a hash of it."""
    safe = re.sub(r"[^\w.,()@ -]", "_", unicodedata.normalize("NFC", student))
    safe = safe.strip(" .").lstrip("-@").replace("..", "_")
    while len(safe.encode()) > LONGEST:
        safe = safe[:-1]
    safe = safe.rstrip(" .")
    plain = safe.casefold() not in TAKEN and safe.partition(".")[0].rstrip().casefold() not in RESERVED
    if safe == student and plain and not HASHED.search(safe):
        return safe
    return f"{safe or 'student'}-{hashlib.sha256(student.encode()).hexdigest()[:8]}"
