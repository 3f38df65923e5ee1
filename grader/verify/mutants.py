"""Mutants of a solution: the same file with one planted defect. A defect that no check notices is not tested for.

`proof.py` grades those that are chosen here.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from itertools import zip_longest

from gz_course.grader.edits import Edit

MOST = 12  # mutants of one solution that are graded


def choose(mutants: list[Edit], most: int) -> list[Edit]:
    """Return at most `most` of them by a fixed rule, in the order of their lines.

    The rule takes one of each operator, then a second of each, and so on; within an operator the order is that of the
    hashes of the changes, so that neither the beginning nor the end of a file is preferred.
    """
    by_operator: dict[str, list[Edit]] = defaultdict(list)
    for mutant in sorted(mutants, key=_hash):
        by_operator[mutant.operator].append(mutant)
    rounds = zip_longest(*(by_operator[name] for name in sorted(by_operator)))
    chosen = [mutant for each in rounds for mutant in each if mutant is not None][:most]
    return sorted(chosen, key=lambda mutant: (mutant.line, mutant.change))


def _hash(mutant: Edit) -> str:
    return hashlib.sha256(f"{mutant.was} -> {mutant.now} {mutant.line}".encode()).hexdigest()
