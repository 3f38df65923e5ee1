"""A reader for the tables of an author's TOML file: every error names the file, the table and the key.

Raises ManifestError for a key that is missing, of the wrong type, out of range or unknown (with the nearest known one).
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NoReturn

from gz_course.grader.errors import ManifestError
from gz_course.sim.did_you_mean import did_you_mean


class Table:
    """A TOML table, read key by key.

    `raw` is its content, `where` names the table and `noun` its keys in errors; names of files are relative to
    `folder`. Every getter takes the key and, if the key is optional, a default. Call `end()` after the last key to
    refuse unknown ones.
    """

    def __init__(self, raw: Any, where: str, noun: str = "key", folder: Path | None = None) -> None:
        if not isinstance(raw, dict):
            raise ManifestError(f"{where} must be a table, not {raw!r}")
        self._raw: dict[str, Any] = raw
        self.where = where
        self._noun = noun
        self.folder = folder
        self._asked: set[str] = set()

    @staticmethod
    def load(path: Path) -> Table:
        try:
            return Table(tomllib.loads(path.read_text(encoding="utf-8")), str(path), folder=path.parent)
        except OSError as error:
            raise ManifestError(f"{path} cannot be read: {error.strerror}") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ManifestError(f"{path}: {error}") from None

    def refuse(self, key: str, wanted: str) -> NoReturn:
        """Raise ManifestError saying what the value of a key must be."""
        shown = repr(self._raw.get(key))
        raise ManifestError(f"{self.where}: {key} must be {wanted}, not {shown[:80]}")

    def has(self, key: str) -> bool:
        self._asked.add(key)
        return key in self._raw

    def any(self, key: str, *default: Any) -> Any:
        """Return a value of any type."""
        if self.has(key):
            return self._raw[key]
        if default:
            return default[0]
        raise ManifestError(f"{self.where} lacks the {self._noun} {key!r}")

    def text(self, key: str, *default: str) -> str:
        """Return a text that is not empty."""
        value = self.any(key, *default)
        if not isinstance(value, str) or (not value.strip() and key in self._raw):
            self.refuse(key, "a text")
        return value

    def number(self, key: str, *default: float, above: float = -math.inf, infinite: bool = False) -> float:
        """Return a number greater than `above`, finite unless `infinite`."""
        value = self.any(key, *default)
        if isinstance(value, bool) or not isinstance(value, int | float) or math.isnan(value):
            self.refuse(key, "a number")
        if key in self._raw and not infinite and not (math.isfinite(value) and value > above):
            self.refuse(key, f"a finite number greater than {above:g}" if math.isfinite(above) else "a finite number")
        return value

    def flag(self, key: str, *default: bool) -> bool:
        value = self.any(key, *default)
        if not isinstance(value, bool):
            self.refuse(key, "true or false")
        return value

    def integer(self, key: str, *default: int) -> int:
        value = self.any(key, *default)
        if type(value) is not int:
            self.refuse(key, "a whole number")
        return value

    def numbers(self, key: str, lengths: list[int], *default: list[float]) -> list[float]:
        """Return a list of finite numbers whose length is one of `lengths`."""
        value = self.any(key, *default)
        fine = isinstance(value, list | tuple) and len(value) in set(lengths)
        if not fine or any(
            isinstance(v, bool) or not isinstance(v, int | float) or not math.isfinite(v) for v in value
        ):
            self.refuse(key, f"a list of {' or '.join(map(str, lengths))} numbers")
        return list(value)

    def texts(self, key: str) -> list[str]:
        """Return a list of at least one text."""
        value = self.any(key)
        if not isinstance(value, list) or not value or not all(isinstance(v, str) and v for v in value):
            self.refuse(key, "a list of texts, at least one")
        return value

    def choice(self, key: str, known: Iterable[str]) -> str:
        """Return one of the known words."""
        value = self.text(key)
        names = list(known)
        if value not in names:
            raise ManifestError(f"{self.where}: {key} is {value!r}{did_you_mean(value, names, listing='known')}")
        return value

    def regex(self, key: str) -> re.Pattern[str]:
        try:
            return re.compile(self.text(key))
        except re.error as error:
            raise ManifestError(f"{self.where}: {key} is no regular expression: {error}") from None

    def pattern(self, key: str) -> re.Pattern[str]:
        """Return a regular expression with at least one group."""
        pattern = self.regex(key)
        if not pattern.groups:
            self.refuse(key, "a regular expression with a group, the answer")
        return pattern

    def table(self, key: str, *default: dict[str, Any]) -> Table:
        """Return a table inside this one."""
        return Table(self.any(key, *default), f"{self.where}: {key}", self._noun, self.folder)

    def free(self, key: str) -> dict[str, Any]:
        """Return a table as it is, without checking its keys; empty if it is left out."""
        value = self.any(key, {})
        if not isinstance(value, dict):
            self.refuse(key, "a table")
        return value

    def tables(self, key: str, *default: list[Any]) -> list[Table]:
        """Return a list of tables; at least one unless there is a default."""
        value = self.any(key, *default)
        if not isinstance(value, list) or (not value and not default):
            self.refuse(key, "a list of tables")
        return [
            Table(raw, f"{self.where}: {key} {number}", self._noun, self.folder) for number, raw in enumerate(value, 1)
        ]

    def names(self) -> list[str]:
        """Return all keys of the table and count them as read: for tables whose keys are free."""
        self._asked |= self._raw.keys()
        return list(self._raw)

    def rest(self) -> dict[str, Any]:
        """Return everything not read yet."""
        left = {key: value for key, value in self._raw.items() if key not in self._asked}
        self._asked |= left.keys()
        return left

    def end(self) -> None:
        """Raise ManifestError for a key that was never read: probably a typing mistake."""
        for key in self._raw:
            if key not in self._asked:
                hint = did_you_mean(key, self._asked, listing="known")
                raise ManifestError(f"{self.where}: unknown {self._noun} {key!r}{hint}")
