"""CSV files as spreadsheets and platforms write them: any of four delimiters, UTF-8 or not, with a byte order mark."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from gz_course.grader.errors import UsageError

LARGEST = 64 << 20  # [bytes]
DELIMITERS = ",;\t:"


def text_of(path: Path) -> str:
    """Return the text of a file in UTF-8, in UTF-16 (Excel's Unicode text), or else in Windows-1252.

    Raises UsageError if it cannot be read.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise UsageError(f"{path} has {path.stat().st_size} bytes; such a file has at most {LARGEST}")
        data = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from None
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", "replace")


def rows_of(path: Path, text: str) -> list[tuple[int, list[str]]]:
    """Return (line, cells) of every row, with the delimiter that gives the header the most columns.

    Raises UsageError if the text is no CSV, or has no row.
    """
    first = next((line for line in text.splitlines() if line.strip()), "")
    delimiter = max(DELIMITERS, key=lambda each: (len(next(csv.reader([first], delimiter=each), [])), each == ","))
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
    try:
        rows = [(reader.line_num, row) for row in reader if row]
    except csv.Error as error:
        raise UsageError(f"{path}, line {reader.line_num}: {error}; expected a CSV file") from None
    if not rows:
        raise UsageError(f"{path} is empty; expected a CSV file")
    return rows
