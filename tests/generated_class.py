"""A class of any size for tests, benchmarks and long runs: 200 different texts, and names with every trouble.

    python -m gz_course.tests.generated_class COUNT FOLDER

The texts are those of `solutions/03_teleop` with its variants, with other names, comments and blank lines. A class is
the same each time it is made. Where a file system refuses a name, the student has a plain one.
"""

import itertools
import random
import re
import sys
import unicodedata
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
FILE = "teleop_node.py"
DIFFERENT = 200
RENAMED = {
    "Teleop": ("Driver", "TeleopNode", "MyRobot", "Aufgabe", "Steering"),
    "publish_command": ("tick", "on_timer", "drive", "callback", "send"),
    "command": ("msg", "twist", "cmd", "message", "velocity"),
    "now": ("current", "t", "stamp", "time_now", "present"),
    "DRIVING_TIME": ("LIMIT", "FIVE_SECONDS", "DAUER", "HOW_LONG", "T_MAX"),
    "publisher": ("pub", "cmd_pub", "out", "velocity_publisher", "sender"),
}
REMARKS = ("# TODO", "# see the lecture", "# five seconds", "# très important", "# コマンド", "# do not change")
FIRST = ("Ada", "Grace", "Linus", "Jürgen", "Zoë", "Nguyễn", "李", "Ольга", "محمد", "Søren", "María José", "Ngozi")
LAST = ("Lovelace", "O'Brien-Smith", "Müller", "Østergård", "王", "Иванова", "الأحمد", "de la Cruz", "Okafor")
TROUBLES = (
    "=1+1", "+49 30", "-rf", "@SUM(A1)", "con", "NUL.txt", "aux", "COM1", ".hidden student", "trailing dot.",
    "trailing ", " leading", "two\nlines", "a\ttab", "bell\a", "\x1b[31mred\x1b[0m", "<script>alert(1)<",
    "&amp;", "'; DROP TABLE x", "%2e%2e%2f", "..", "...", "~root", "$HOME", "`id`", "*?[a]", "a\\b", "c:d",
    "pipe|d", '"quoted"', "x" * 250, "é" * 120, unicodedata.normalize("NFC", "Zoë Ångström"),
    unicodedata.normalize("NFD", "Zoë Ångström"), "JANE DOE", "Jane Doe", "jane doe", "STRASSE", "straße",
    "İstanbul", "istanbul", "\N{RIGHT-TO-LEFT OVERRIDE}fdp.exe", "שלום עולם",
    "\N{ARABIC LETTER MEEM}\N{ZERO WIDTH NON-JOINER}\N{ARABIC LETTER NOON}", "👩🏽‍🚀", "🇩🇪",
    "a\N{ZERO WIDTH SPACE}b", "ab", "\N{BOM}mark", "Ａｄａ", "ﬁ", "\N{LINE SEPARATOR}", "\N{NO-BREAK SPACE}",
    "gradebook.csv", "journal.jsonl", "index.html", "null", "None", "0", "1e5", "TRUE", "a,b;c",
    "Z" + "\N{COMBINING GRAVE ACCENT}" * 60, "\N{HANGUL FILLER}",
)  # fmt: skip


def texts() -> list[bytes]:
    """`DIFFERENT` submissions, the solution first."""
    solution = ROOT / "solutions/03_teleop"
    sources = [solution, *sorted(solution.glob("accepted/*")), *sorted(solution.glob("rejected/*"))]
    bases = [(folder / FILE).read_text() for folder in sources]
    chance, found = random.Random("a class"), list(bases)
    while len(found) < DIFFERENT:
        text = bases[len(found) % len(bases)]
        for name, others in RENAMED.items():
            if (other := chance.choice((name, *others))) not in text:
                text = re.sub(rf"\b{name}\b(?!\()" if name == "now" else rf"\b{name}\b", other, text)
        lines = text.splitlines()
        for _ in range(chance.randrange(3)):
            lines.insert(len(lines) - 4, chance.choice(REMARKS))
        lines += [f"# {chance.choice(REMARKS)[2:]} {chance.randrange(1000)}"] * chance.randrange(3)
        text = "\n".join(lines) + "\n"
        if text not in found:
            found.append(text)
    return [text.encode() for text in found]


def names() -> Iterator[str]:
    """Names of students without end: troublesome ones first, then ordinary ones."""
    yield from TROUBLES
    for number in itertools.count():
        first, last = FIRST[number % len(FIRST)], LAST[number // len(FIRST) % len(LAST)]
        yield f"{first} {last} {number}"


def hand_in(folder: Path, count: int) -> Path:
    """Write a class of `count` students, a folder each, as Moodle's exports are; return the folder."""
    folder.mkdir(parents=True)
    found = texts()
    for number, name in zip(range(count), names(), strict=False):
        for entry in (f"{name}_{number}_assignsubmission_file_", f"student {number}_{number}_assignsubmission_file_"):
            try:
                (folder / entry).mkdir()
            except OSError:
                continue
            (folder / entry / FILE).write_bytes(found[number % len(found)])
            break
    return folder


if __name__ == "__main__":
    hand_in(Path(sys.argv[2]), int(sys.argv[1]))
