"""Proves an exercise: its solution and accepted variants earn full marks, its starter nothing, every rejected variant
loses exactly what it declares and is told why.

The private half of an exercise is its twin in `solutions/`: the solved file, `accepted/STYLE/`, `rejected/FAULT/` and
`expect.toml`. Nothing may be missing, orphaned or without effect: a check that no rejected variant fails proves
nothing and is reported.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from grader.errors import ManifestError, nearest
from grader.exercise import Exercise
from grader.grade import grade
from grader.report.report import Report
from grader.table import Table

FEWEST_ACCEPTED = 2
FEWEST_REJECTED = 4


@dataclass(frozen=True)
class Variant:
    """One file to grade, the checks it must fail (the starter: all), and words its first line of feedback must hold."""

    name: str
    file: Path
    fails: frozenset[str]
    words: tuple[str, ...] = ()


@dataclass
class Proof:
    """What became of one variant."""

    variant: Variant
    failed: frozenset[str]
    report: Report
    faults: list[str] = field(default_factory=list)


@dataclass
class Verification:
    """What became of an exercise: a row for each variant, and what is wrong with the exercise as a whole."""

    exercise: Exercise
    proofs: list[Proof] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)

    @property
    def proven(self) -> bool:
        """Whether nothing at all is wrong."""
        return not self.faults and not any(proof.faults for proof in self.proofs)


def twin(exercise: Exercise) -> Path:
    """Return the folder with an exercise's private half."""
    return exercise.folder.parents[1] / "solutions" / exercise.name


def variants(exercise: Exercise) -> list[Variant]:
    """Return everything `expect.toml` and the folders declare. Raises ManifestError for what does not fit together."""
    folder = twin(exercise)
    path = folder / "expect.toml"
    if not path.is_file():
        raise ManifestError(f"{folder} has no expect.toml, which says what each rejected variant must lose")
    expect = Table.load(path)
    expected = expect.table("rejected")
    expect.end()
    every = frozenset(check.id for check in exercise.checks)
    found = [
        Variant("starter", exercise.starter, every),
        Variant("solution", folder / exercise.file, frozenset()),
    ]
    found += [Variant(f"accepted/{p.name}", p / exercise.file, frozenset()) for p in _folders(folder / "accepted")]
    rejected = {p.name: p for p in _folders(folder / "rejected")}
    declared = expected.names()
    for name in declared:
        if name not in rejected:
            raise ManifestError(f"{path}: no folder rejected/{name}{nearest(name, rejected)}")
    for name, variant in rejected.items():
        if name not in declared:
            raise ManifestError(f"{variant} is not declared in expect.toml{nearest(name, declared)}")
        entry = expected.table(name)
        entry.where = f"{path}: rejected.{name}"
        loses, words = frozenset(entry.texts("fails")), tuple(entry.texts("words"))
        entry.end()
        for check in sorted(loses - every):
            raise ManifestError(f"{entry.where} names no check of {exercise.name}: {check}{nearest(check, every)}")
        found.append(Variant(f"rejected/{name}", variant / exercise.file, loses, words))
    for each in found:
        if not each.file.is_file():
            names = [p.name for p in each.file.parent.iterdir()] if each.file.parent.is_dir() else []
            raise ManifestError(f"{each.file.parent} has no {exercise.file}{nearest(exercise.file, names)}")
    return found


def orphans(root: Path, names: list[str]) -> list[Path]:
    """Return the folders of `solutions/` that are the twin of no exercise."""
    return [path for path in _folders(root / "solutions") if path.name not in names]


def _folders(path: Path) -> list[Path]:
    return sorted(p for p in path.iterdir() if p.is_dir()) if path.is_dir() else []


def verify(exercise: Exercise, out: Path) -> Iterator[Verification]:
    """Grade every variant; yield the growing result after each, the complete one last."""
    result = Verification(exercise)
    declared = variants(exercise)
    for kind, fewest in (("accepted", FEWEST_ACCEPTED), ("rejected", FEWEST_REJECTED)):
        count = sum(v.name.startswith(f"{kind}/") for v in declared)
        if count < fewest:
            result.faults.append(f"{count} {kind} variants, at least {fewest} are needed")
    for check in exercise.checks:
        if not any(check.id in v.fails for v in declared if v.name.startswith("rejected/")):
            result.faults.append(f"no rejected variant fails the check {check.id}: it proves nothing")
    for variant in declared:
        result.proofs.append(_prove(exercise, variant, out))
        yield result


def _prove(exercise: Exercise, variant: Variant, out: Path) -> Proof:
    report = grade(exercise, variant.file, out / variant.name)
    failed = frozenset(check.spec.id for check in report.score.checks if not check.finding.passed)
    proof = Proof(variant, failed, report)
    for check in sorted(failed - variant.fails):
        measured = next(c.finding.measured for c in report.score.checks if c.spec.id == check)
        proof.faults.append(f"fails {check}, which it must pass: {measured}")
    proof.faults += [f"passes {check}, which it must fail" for check in sorted(variant.fails - failed)]
    told = " ".join([report.score.diagnosis, *(c.finding.measured + c.spec.hint for c in report.score.checks)])
    first = report.score.diagnosis
    for word in variant.words:
        if word not in first:
            where = "only further down" if word in told else "nowhere"
            proof.faults.append(f"its first line of feedback does not say {word!r} ({where} does it stand): {first!r}")
    return proof
