"""The first sentence of feedback: what a reader sees at once. The rest of it folds.

A sentence that is too long is cut where a clause ends; what comes after the cut begins the rest.
"""

from __future__ import annotations

import re

MOST_WORDS = 26  # so that with the name of a trial before it there are 30
SENTENCE = re.compile(r"(?<=[.?!])(?<!\be\.g\.)(?<!\bi\.e\.) +(?=[\"'(<`]*(?:[A-Z0-9/~]|\w+(?:[._]\w|\()))")
COMMANDS = frozenset({"gz", "colcon", "course", "rclpy", "xacro"})
PLACE = re.compile(r"(?::|\bline )\d+$")  # the line in `file:12: what`, which is better not parted from it
NOTHING = re.compile(r"(?:: \S+, line \d+)?\.")  # what may stand behind a title that says nothing of a fault
CLAUSE = re.compile(r"; |: (?![A-Z]+_[A-Z])|\. | \((?=[^()]*\)\.?$)")
ALTERNATIVE = re.compile(r", (?=or |so )")  # where a sentence is cut that has no clauses


def split_first(text: str, most: int = MOST_WORDS) -> tuple[str, str]:
    """Return the first sentence of a text, of at most so many words if it has a place to be cut, and the rest."""
    sentences = SENTENCE.split(text.strip(" "), maxsplit=1)
    first, rest = sentences[0], sentences[1] if len(sentences) > 1 else ""
    if words(first) > most and (cut := _cut(first, most)):
        end = first[cut.end() :].strip()
        end = end.removesuffix(").") if cut.group().strip() == "(" else end
        first = first[: cut.start()]
        if first.count("(") > first.count(")"):  # a bracket is closed where it is cut
            first += ")"
            end = end[::-1].replace(")", "", 1)[::-1]
        first += "."
        rest = " ".join(filter(None, (_sentence(end), rest)))
    return first, rest


def first_of(text: str, title: str) -> tuple[str, str]:
    """Split a text that may begin with the title of a check. The first sentence says more than that, and a place."""
    first, rest = split_first(text)
    if title and first.startswith(title) and NOTHING.fullmatch(first[len(title) :]):
        fault, more = split_first(_sentence(text[len(title) :].removeprefix(": ")))
        if words(fault) <= MOST_WORDS:
            why, measured, seen = more.partition("Measured: ")
            return fault, " ".join(filter(None, (why.strip(), f"{title}.", f"{measured}{seen}")))
    return first, rest


def words(text: str) -> int:
    """Return the number of words of a text, as a reader counts them."""
    return len(text.split())


def _cut(sentence: str, most: int) -> re.Match[str] | None:
    """Return the last place at which at most so many words, and at least four, stand before a cut."""
    found = ([*pattern.finditer(sentence)] for pattern in (CLAUSE, ALTERNATIVE))
    fitting = ([cut for cut in cuts if 4 <= words(sentence[: cut.start()]) <= most] for cuts in found)
    places = next(filter(None, fitting), [])
    whole = [cut for cut in places if not PLACE.search(sentence[: cut.start()])]
    return next(reversed(whole or places), None)


def _sentence(text: str) -> str:
    """Return a clause as a sentence of its own. A name of code keeps its small letter."""
    if re.match(r"[a-z]+[\s,]", text) and text.split()[0] not in COMMANDS:
        text = text[0].upper() + text[1:]
    return text if text.endswith((".", "?", "!")) else f"{text}."
