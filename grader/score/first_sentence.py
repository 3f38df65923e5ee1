"""The first sentence of feedback: what a reader sees at once. The rest of it folds.

A sentence that is too long is cut where a clause ends; what comes after the cut begins the rest.
"""

from __future__ import annotations

import re

MOST_WORDS = 26  # so that with the name of a trial before it there are 30
SENTENCE = re.compile(r"(?<=[.?!])(?<!\be\.g\.)(?<!\bi\.e\.) +(?=[\"'(<`]*(?:[A-Z0-9/~]|\w+(?:[._]\w|\()))")
CLAUSE = re.compile(r"; |: |\. | \((?=[^()]*\)\.?$)")


def split_first(text: str, most: int = MOST_WORDS) -> tuple[str, str]:
    """Return the first sentence of a text, of at most so many words if it has a place to be cut, and the rest."""
    sentences = SENTENCE.split(text.strip(" "), maxsplit=1)
    first, rest = sentences[0], sentences[1] if len(sentences) > 1 else ""
    if words(first) > most and (cut := _cut(first, most)):
        end = first[cut.end() :].strip()
        end = end.removesuffix(").") if cut.group().strip() == "(" else end
        rest = " ".join(filter(None, (_sentence(end), rest)))
        first = first[: cut.start()] + "."
    return first, rest


def words(text: str) -> int:
    """Return the number of words of a text, as a reader counts them."""
    return len(text.split())


def _cut(sentence: str, most: int) -> re.Match[str] | None:
    """Return the last place at which at most so many words, and at least four, stand before a cut."""
    places = [cut for cut in CLAUSE.finditer(sentence) if 4 <= words(sentence[: cut.start()]) <= most]
    return places[-1] if places else None


def _sentence(text: str) -> str:
    """Return a clause as a sentence of its own. A name of code keeps its small letter."""
    if re.match(r"[a-z]+[\s,]", text):
        text = text[0].upper() + text[1:]
    return text if text.endswith((".", "?", "!")) else f"{text}."
