"""The numbers and names that a text tells a reader, in any unit in which they may be written."""

from __future__ import annotations

import math
import re

WORDS = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"]
OTHERS = {"half": 0.5, "twice": 2.0, "once": 1.0, "quarter": 0.25, "a second": 1.0, "a metre": 1.0}
UNITS = {"cm": 0.01, "mm": 0.001, "%": 0.01, "ms": 0.001, "degrees": math.pi / 180}
NUMBER = r"(?<![\w.])-?\d+(?:\.\d+)?(?!\.?\d)"
QUANTITY = re.compile(rf"(?P<number>{NUMBER})(?:\s?(?P<unit>cm|mm|%|ms|degrees)(?!\w))?")
RATIO = re.compile(rf"(?P<part>{NUMBER}|{'|'.join(WORDS)}) of (?P<whole>{NUMBER}|{'|'.join(WORDS)})\b")
NEAR = 1e-9


class Told:
    """What a text tells; the table of points is no part of it."""

    def __init__(self, text: str) -> None:
        self.text = " ".join(text.partition("\n## Points")[0].split())
        self.numbers = {_value(found["number"]) for found in QUANTITY.finditer(self.text)}
        self.numbers |= {
            _value(found["number"]) * UNITS[found["unit"]] for found in QUANTITY.finditer(self.text) if found["unit"]
        }
        self.numbers |= {_value(found["part"]) / _value(found["whole"]) for found in RATIO.finditer(self.text)}
        lower = self.text.lower()
        self.numbers |= {float(n) for n, word in enumerate(WORDS) if re.search(rf"\b{word}\b", lower)}
        self.numbers |= {value for word, value in OTHERS.items() if re.search(rf"\b{word}\b", lower)}

    def has(self, what: float | str) -> bool:
        """Return whether the text tells a number, or has a name. A bound on both sides is told without a sign."""
        if isinstance(what, str):
            return what in self.text
        return any(abs(abs(each) - abs(what)) < NEAR for each in self.numbers)


def _value(text: str) -> float:
    return float(WORDS.index(text)) if text in WORDS else float(text)
