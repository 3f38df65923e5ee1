"""Similar submissions are found whatever their names, hostile ones cost little, and given code is no sign."""

import csv
import io
import random
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.commands.similar import command
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.similarity import tokens
from gz_course.grader.similarity.class_texts import given_code
from gz_course.grader.similarity.fingerprints import RUN, WINDOW, runs, winnowed
from gz_course.grader.similarity.pairs import FEWEST, NEIGHBOURS, find_similar
from gz_course.grader.similarity.report import CSV, PAGE, Submitted, as_csv, as_page
from gz_course.grader.similarity.tokens import LARGEST, Text, read_text

COPIED = b"""
def mean_of_the_valid(self, message):
    total, count = 0.0, 0
    for distance in message.ranges:
        if message.range_min <= distance <= message.range_max:
            total += distance
            count += 1
    self.get_logger().info(f"{count} valid")
    return total / count if count else None
"""
RENAMED = b"""
# my own work!
def average(this, scan):
    s, n = 0.0, 0   # sum
    for d in scan.ranges:

        if scan.range_min <= d <= scan.range_max:
            s += d
            n += 1
    this.get_logger().info(f"valid: {n}")
    return s / n if n else None
"""
OTHER = b"""
import math
class Reader:
    def __init__(self): self.values = []
    def valid(self, scan):
        good = [r for r in scan.ranges if math.isfinite(r)]
        self.values.extend(good); self.values = self.values[-10:]
        while len(self.values) > 3 and max(self.values) > 2 * min(self.values): self.values.remove(max(self.values))
        return sum(self.values) / len(self.values)
"""


def text(source, name="a.py"):
    return read_text({name: source})


def random_text(chance, length=300):
    symbols = np.array([chance.randrange(1, 40) for _ in range(length)], np.uint64)
    return Text(symbols, np.arange(length, dtype=np.int32) // 8 + 1, np.zeros(length, np.int32), ("a.py",))


def test_names_comments_and_layout_make_no_difference():
    similar = find_similar([text(COPIED), text(OTHER), text(RENAMED)], [], 0.5)
    assert (similar.groups, similar.pairs, similar.too_short) == ([[0, 2]], [], [])


def test_a_part_that_was_copied_is_found_with_its_lines():
    one, other = text(COPIED + b"\nprint('mine')\n"), text(b"import os\nx = os.environ\n" + RENAMED + OTHER)
    (pair,) = find_similar([one, other], [], 0.9).pairs
    assert (pair.one, pair.other) == (0, 1) and pair.similarity >= 0.9
    assert {line for _, line in pair.lines[0]} >= set(range(2, 10)) - {8}
    assert {line for _, line in pair.lines[1]} <= set(range(4, 15))


def test_given_code_is_no_sign():
    starter = text(COPIED)
    similar = find_similar([text(COPIED), text(COPIED + b"print(1)\n"), text(COPIED + OTHER)], [starter], 0.1)
    assert (similar.groups, similar.pairs, similar.too_short) == ([], [], [0, 1])


def test_what_most_of_a_class_writes_is_no_sign():
    chance = random.Random(1)
    shared = random_text(chance, 60).symbols
    texts = []
    for _ in range(12):
        own = random_text(chance, 200)
        texts.append(Text(np.concatenate([shared, own.symbols[60:]]), own.lines, own.files, own.names))
    assert find_similar(texts, [], 0.1).pairs == []


def test_a_clique_in_a_large_class_is_found_and_the_work_does_not_grow_with_the_square():
    chance, count = random.Random(2), 200
    texts = [random_text(chance, 120) for _ in range(count)]
    for number in range(0, count, 4):  # every fourth has copied most of one text
        texts[number].symbols[:90] = texts[0].symbols[:90]
    clique = set(range(0, count, 4))
    similar = find_similar(texts, [], 0.5)
    assert {number for pair in similar.pairs for number in (pair.one, pair.other)} == clique
    assert len(similar.pairs) <= len(clique) * NEIGHBOURS < len(clique) * (len(clique) - 1) / 2


@given(st.integers(0, 2**32 - 1), st.integers(RUN + WINDOW - 1, 60))
def test_every_long_run_that_two_texts_share_is_selected_in_both(seed, length):
    chance = random.Random(seed)
    one, other = random_text(chance, 120), random_text(chance, 120)
    start, to = chance.randrange(120 - length), chance.randrange(120 - length)
    other.symbols[to : to + length] = one.symbols[start : start + length]
    assert len(np.intersect1d(winnowed(runs(one), 1000), winnowed(runs(other), 1000)))


def test_hostile_files_are_left_out_or_read(monkeypatch):
    files = {
        "big.py": b"x = 1\n" * (LARGEST // 6 + 1),
        "binary.py": b"\0\1\2",
        "deep.py": b"(" * 5_000,
        "indented.py": b"".join(b" " * depth + b"if 1:\n" for depth in range(100)),
        "noise.py": bytes(range(1, 256)) * 4,
        "strings.py": b'"""' * 501 + b"'" * 2_001,
        "notes.txt": b"not compared",
        "launch.xml": b"<a>" * 500,
    }
    found = read_text(files)
    assert {each.split()[0] for each in found.left_out} >= {"big.py", "binary.py"}
    assert "notes.txt" not in found.names and len(found.symbols) <= tokens.MOST_TOKENS
    assert len(found.symbols) == len(found.lines) == len(found.files)

    def endless(*_):
        while True:
            yield 1, 1

    monkeypatch.setattr(tokens, "_symbols", endless)
    monkeypatch.setattr(tokens, "LONGEST", 0.05)
    assert read_text({"slow.py": b"x"}).left_out == ("slow.py takes too long to read",)


@given(st.binary(max_size=300), st.sampled_from(sorted(tokens.LEXERS)))
def test_any_bytes_are_read(data, suffix):
    found = read_text({f"a{suffix}": data})
    assert len(found.left_out) == (b"\0" in data)
    assert all(1 <= line <= data.count(b"\n") + data.count(b"\r") + 1 for line in found.lines)


def test_the_report_shows_foreign_text_and_runs_none_of_it():
    names = ["=cmd()", "<script>alert(1)</script>", "Zoë", "x"]
    sources = [COPIED + b"a = '<script>alert(2)</script>'\n", RENAMED + OTHER, COPIED, RENAMED]
    submitted = [Submitted(name, {"a.py": source}, text(source)) for name, source in zip(names, sources, strict=True)]
    similar = find_similar([each.text for each in submitted], [], 0.6)
    page = as_page("03 <b>", submitted, similar, 0.6)
    assert "<script" not in page and "&lt;script&gt;" in page and "no proof" in page
    assert "def average(this, scan):" in page
    rows = list(csv.DictReader(io.StringIO(as_csv(submitted, similar))))
    assert rows[0]["student_a"] == "Zoë" and rows[0]["student_b"] == "x" and rows[0]["similarity"] == "1"
    assert all(re.fullmatch(r"(\d+(-\d+)?(, )?)+|all", row["lines_a"]) for row in rows)
    assert "'=cmd()" in {row["student_a"] for row in rows} | {row["student_b"] for row in rows}


def test_the_command(root, tmp_path, capsys):
    folder = tmp_path / "class"
    solution = root / "solutions/04_lidar_listener"
    file = find_exercise("04_lidar_listener", root).file
    for student, path in {"ada": solution, "eve": solution, "bob": root / "exercises/04_lidar_listener"}.items():
        (folder / student).mkdir(parents=True)
        (folder / student / file).write_bytes((path / file).read_bytes())
    (folder / "empty").mkdir()
    command("04", folder, tmp_path / "out", 0.6)
    told = capsys.readouterr()
    assert "3 submissions compared: 2 are equal" in told.out and "no proof" in told.out
    assert "cannot be read: empty" in told.err
    rows = list(csv.DictReader(io.StringIO((tmp_path / "out" / CSV).read_text())))
    assert [(row["student_a"], row["student_b"]) for row in rows] == [("ada", "eve")]
    assert "bob" in (tmp_path / "out" / PAGE).read_text().partition("Not compared")[2]
    assert len(given_code(find_exercise("04", root))[0].symbols) > FEWEST
    with pytest.raises(UsageError, match="there is no"):
        command("04", tmp_path / "gone", tmp_path / "out", 0.6)
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="cannot be written"):
        command("04", folder, tmp_path / "file" / "out", 0.6)


def test_clones_of_github_classroom_have_the_names_of_the_map(root, tmp_path):
    solution = root / "solutions/04_lidar_listener"
    file = find_exercise("04_lidar_listener", root).file
    for folder in ("04-lidar-ada99", "04-lidar-eve"):
        (tmp_path / "class" / folder).mkdir(parents=True)
        (tmp_path / "class" / folder / file).write_bytes((solution / file).read_bytes())
    (tmp_path / "map.csv").write_text("login,student\nada99,Ada L\neve,Eve\n")
    command("04", tmp_path / "class", tmp_path / "out", 0.6, tmp_path / "map.csv")
    (row,) = csv.DictReader(io.StringIO((tmp_path / "out" / CSV).read_text()))
    assert {row["student_a"], row["student_b"]} == {"Ada L", "Eve"}
