"""One line of the benchmark table."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    name: str
    measured: str
    reference: str
    ratio: str
    wanted: str
