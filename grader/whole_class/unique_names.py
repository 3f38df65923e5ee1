"""Names of students that nobody can confuse: neither a person, nor a file system that folds case or accents."""

from __future__ import annotations

import unicodedata
from collections import Counter


def folded(name: str) -> str:
    """Return what all spellings of a name have in common: case, and composed or combining accents, make no difference.

    Source: The Unicode Standard, section 3.13.5, D145 (canonical caseless matching).
    """
    return unicodedata.normalize("NFD", unicodedata.normalize("NFD", name).casefold())


def unique_names(names: list[str], ids: list[str]) -> list[str]:
    """Return names that stay different when they are folded.

    Students of one name get their id where it is known, as in `Jane Doe (17)`; names that are still alike are numbered.
    """
    twice = Counter(names)
    longer = [f"{name} ({id})" if twice[name] > 1 and id else name for name, id in zip(names, ids, strict=True)]
    alike = Counter(longer)
    taken: set[str] = set()
    following: Counter[str] = Counter()  # the last number that was tried for a name
    found = []
    for name in longer:
        label = name
        while folded(label) in taken or (label == name and alike[name] > 1):
            following[name] += 1
            label = f"{name} [{following[name]}]"
        taken.add(folded(label))
        found.append(label)
    return found
