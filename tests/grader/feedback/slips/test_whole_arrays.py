"""Fractions that are added to the numbers of an array of whole numbers, counters in bytes, and what holds them."""

import pytest

from gz_course.grader.feedback.slips import slips

MAPPER = """\
HIT, PASS = 0.9, -0.4
L_HIT = math.log(0.7 / 0.3)
class Mapper(Node):
    def __init__(self):
        self.odds = np.zeros((80, 100), dtype=int)
    def on_scan(self, scan):
        CHANGE
    def mark(self, cell, amount):
        self.odds[cell] += amount
"""
CUT = [
    "self.odds[cells] += HIT",
    "self.odds[row, column] -= 0.4",
    "self.odds[row][column] += L_HIT",
    "self.odds[cells] = self.odds[cells] + PASS",
    "self.odds[cells] = np.maximum(self.odds[cells] + PASS, -4)",
    "self.odds[cells] = min(4, self.odds[cells] + (HIT if hit else PASS))",
    "before = self.odds[cells]\n        self.odds[cells] = np.minimum(before + HIT, 4.0)",
    "self.mark(cell, HIT)",
]
KEPT = [
    "self.odds[cells] += 2",
    "self.odds[cells] = np.round(self.odds[cells] + HIT)",
    "self.odds[cells] = 100 * share",
    "self.odds = self.odds + HIT",
    "self.mark(cell, 3)",
]
MADE = [
    "np.zeros((80, 100), np.int8)",
    "np.full((80, 100), 0)",
    "np.full(8000, -1, dtype='int16').reshape(80, 100)",
    "np.zeros((80, 100)).astype(int)",
]
OF_FLOATS = ["np.zeros((80, 100))", "np.full((80, 100), 0.0)", "np.zeros((80, 100), dtype=np.float32)", "[[0] * 100]"]


def said(source):
    return " ".join(each["said"] for each in slips(source.encode()) if "array of whole numbers" in each["said"])


@pytest.mark.parametrize("change", CUT)
def test_a_fraction_that_is_cut_off(change):
    found = said(MAPPER.replace("CHANGE", change))
    assert "self.odds is an array of whole numbers (line 5" in found and "dtype=float" in found


@pytest.mark.parametrize("change", KEPT)
def test_whole_numbers_stay_unnamed(change):
    assert not said(MAPPER.replace("CHANGE", change))


@pytest.mark.parametrize("made", [*MADE, *OF_FLOATS])
def test_the_kinds_of_arrays(made):
    source = MAPPER.replace("CHANGE", CUT[0]).replace("np.zeros((80, 100), dtype=int)", made)
    assert bool(said(source)) == (made in MADE)


@pytest.mark.parametrize(
    ("made", "change", "words"),
    [
        ("np.zeros((80, 100), dtype=np.int8)", "self.odds[cell] += 1", "end at 127: one more is -128"),
        ("np.zeros((80, 100), np.uint8)", "self.count(self.odds, cell)", "end at 255: one more is 0"),
        ("np.zeros((80, 100), dtype='int8')", "self.odds[cell][0] += 3", "end at 127"),
        ("np.zeros((80, 100), dtype=int)", "self.odds[cell] += 1", ""),
        ("np.zeros((80, 100), dtype=np.int8)", "self.count(cell, self.odds)", ""),
        ("np.zeros((80, 100), dtype=np.int8)", "if self.odds[cell] < 100: self.odds[cell] += 1", ""),
        ("np.zeros((80, 100), dtype=np.int8)", "self.odds[cell] += 1; self.odds = np.clip(self.odds, 0, 100)", ""),
    ],
)
def test_counters_in_bytes(made, change, words):
    source = MAPPER.replace("CHANGE", change).replace("np.zeros((80, 100), dtype=int)", made)
    source += "    def count(self, counter, cell):\n        counter[cell] += 1\n"
    found = [each["said"] for each in slips(source.encode()) if "array of bytes" in each["said"]]
    assert len(found) == bool(words) and all(words in each for each in found)
