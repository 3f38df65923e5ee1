"""Which submissions of a class are similar, found with an index of fingerprints: not every pair is compared.

Submissions whose tokens are equal stand for each other. A fingerprint that more than half of the others have is what
the exercise makes people write, and says nothing. One that many have joins each with its next neighbours only, so that
the work grows with the size of the class and not with its square.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gz_course.grader.similarity.fingerprints import RUN, Hashes, own_runs, runs, winnowed
from gz_course.grader.similarity.tokens import Text

FEWEST = 20  # own tokens, below which there is nothing to compare
FEW = 8  # different texts, below which nothing counts as what everybody writes
NEIGHBOURS = 16  # of a text in the list of a fingerprint, to which it is joined
MOST_POSTINGS = 2_000_000  # of the index
MOST_COMPARED = 20_000  # pairs that are compared token by token


@dataclass(frozen=True)
class Pair:
    """Two submissions by their numbers; `similarity` is the larger share of own tokens that the other has, too.

    `tokens` match, on `lines` of each (file number, line).
    """

    one: int
    other: int
    similarity: float
    tokens: int
    lines: tuple[frozenset[tuple[int, int]], frozenset[tuple[int, int]]]


@dataclass(frozen=True)
class Similar:
    """`groups` of submissions that are equal but for names and layout, and `pairs` of different ones."""

    groups: list[list[int]]
    pairs: list[Pair]
    too_short: list[int]


def find_similar(texts: Sequence[Text], given: Sequence[Text], threshold: float) -> Similar:
    """Compare the submissions of a class; `given` is code that all of them were handed out."""
    known = np.unique(np.concatenate([runs(each) for each in given] or [np.zeros(0, np.uint64)]))
    same: dict[bytes, list[int]] = defaultdict(list)
    for number, text in enumerate(texts):
        same[hashlib.sha256(text.symbols.tobytes() + text.files.tobytes()).digest()].append(number)
    first = [members[0] for members in same.values()]
    hashes = [runs(texts[number]) for number in first]
    own = [own_runs(each, known) for each in hashes]
    common = _common([each[where] for each, where in zip(hashes, own, strict=True)])
    if len(common):
        own = [where[~np.isin(each[where], common)] for each, where in zip(hashes, own, strict=True)]
    covered = [int(_covered(where).sum()) for where in own]
    long_enough = [place for place, count in enumerate(covered) if count >= FEWEST]
    most = max(50, MOST_POSTINGS // max(1, len(long_enough)))
    prints = [winnowed(hashes[place][own[place]], most) for place in long_enough]
    pairs = []
    for a, b in _candidates(prints, threshold):
        one, other = long_enough[a], long_enough[b]
        shared = np.intersect1d(hashes[one][own[one]], hashes[other][own[other]])
        spots = [
            where[np.isin(hashes[place][where], shared)] for place, where in ((one, own[one]), (other, own[other]))
        ]
        masks = [_covered(spot) for spot in spots]
        share = max(float(mask.sum()) / covered[place] for mask, place in zip(masks, (one, other), strict=True))
        if share >= threshold:
            lines = [_lines(texts[first[place]], mask) for mask, place in zip(masks, (one, other), strict=True)]
            tokens = int(min(mask.sum() for mask in masks))
            pairs.append(Pair(first[one], first[other], share, tokens, (lines[0], lines[1])))
    pairs.sort(key=lambda each: (-each.similarity, -each.tokens, each.one, each.other))
    groups = [members for place, members in enumerate(same.values()) if len(members) > 1 and covered[place] >= FEWEST]
    short = [number for place, members in enumerate(same.values()) if covered[place] < FEWEST for number in members]
    return Similar(sorted(groups, key=lambda each: (-len(each), each)), pairs, sorted(short))


def _common(hashes: list[Hashes]) -> Hashes:
    """Return the hashes that more than half of the texts have."""
    if len(hashes) < FEW:
        return np.zeros(0, np.uint64)
    values, counts = np.unique(np.concatenate([np.unique(each) for each in hashes]), return_counts=True)
    return values[counts > len(hashes) / 2]


def _covered(spots: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return which tokens belong to runs that begin at `spots`."""
    mask = np.zeros(int(spots[-1]) + RUN if len(spots) else 0, bool)
    for place in range(RUN):
        mask[spots + place] = True
    return mask


def _lines(text: Text, mask: NDArray[np.bool_]) -> frozenset[tuple[int, int]]:
    where = np.flatnonzero(mask)
    return frozenset(zip(text.files[where].tolist(), text.lines[where].tolist(), strict=True))


def _candidates(prints: list[Hashes], threshold: float) -> list[tuple[int, int]]:
    """Return pairs that share fingerprints enough, the most similar first."""
    if not prints:
        return []
    owners = np.repeat(np.arange(len(prints)), [len(each) for each in prints])
    values = np.concatenate(prints)
    order = np.lexsort((owners, values))
    values, owners = values[order], owners[order]
    found = []
    for step in range(1, NEIGHBOURS + 1):
        joined = values[step:] == values[:-step]
        found.append(owners[:-step][joined] * len(prints) + owners[step:][joined])
    keys, counts = np.unique(np.concatenate(found), return_counts=True)
    if not len(keys):
        return []
    sizes = np.array([len(each) for each in prints])
    ones, others = keys // len(prints), keys % len(prints)
    share = counts / np.minimum(sizes[ones], sizes[others])
    likely = np.flatnonzero(share >= threshold / 2)  # selected fingerprints are a sample: the exact share comes later
    likely = likely[np.argsort(-share[likely], kind="stable")][:MOST_COMPARED]
    return list(zip(ones[likely].tolist(), others[likely].tolist(), strict=True))
