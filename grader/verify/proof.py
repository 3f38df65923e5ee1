"""The proof of an exercise: everything it declares is graded and compared; `course verify` prints the result.

Solution and accepted variants earn full marks in every trial, the starter nothing in any; each rejected variant loses
exactly what it declares, in the public trials or in the hidden one that it names, with the declared feedback. A check
that no rejected variant fails proves nothing and is a fault. Then the solution is changed in one place at a time
(`mutants/`): a mutant that keeps full marks is a survivor, which is a warning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.grader.report.report import Report
from gz_course.grader.score.first_sentence import words
from gz_course.grader.score.score import Score
from gz_course.grader.verify.declared import (
    FEWEST_ACCEPTED,
    FEWEST_REJECTED,
    Variant,
    completed,
    equivalent_mutants,
    variants,
)
from gz_course.grader.verify.jobs import Job, Pool
from gz_course.grader.verify.mutants import MOST, Mutant, choose, mutants_of

REJECTED = "rejected/"

MOST_FIRST, MOST_OPEN = 30, 70  # words of the first sentence, and of it and the hint beside it


@dataclass
class Proof:
    """The result of one variant. `failed` are the checks it failed in any trial."""

    variant: Variant
    failed: frozenset[str]
    report: Report
    faults: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class MutantProof:
    """The result of one mutant; one that failed no check survived."""

    mutant: Mutant
    failed: frozenset[str]


@dataclass
class Verification:
    """The result of an exercise: a row for each variant, and the faults of the exercise as a whole."""

    exercise: Exercise
    proofs: list[Proof] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    mutants: list[MutantProof] = field(default_factory=list)

    @property
    def fault_lines(self) -> list[str]:
        """One line for each fault, beginning with exercise and variant. Mutants that survive are not faults."""
        name = self.exercise.name
        return [f"{name}: {fault}" for fault in self.faults] + [
            f"{name} {proof.variant.name}: {fault}" for proof in self.proofs for fault in proof.faults
        ]

    @property
    def survivors(self) -> list[Mutant]:
        """The mutants that no check noticed."""
        return [proof.mutant for proof in self.mutants if not proof.failed]

    def killed_by(self, check: str) -> tuple[int, int]:
        """Return how many rejected variants and how many mutants fail a check."""
        rejected = [proof for proof in self.proofs if proof.variant.name.startswith(REJECTED)]
        return sum(check in proof.failed for proof in rejected), sum(check in m.failed for m in self.mutants)


def verify(exercise: Exercise, out: Path, pool: Pool, most_mutants: int = MOST) -> Iterator[Verification]:
    """Grade every variant and mutant; yield the growing result after each, the complete one last.

    The recordings go to the folder `out`. Raises ManifestError if the halves do not agree.
    """
    result = Verification(exercise)
    declared = variants(exercise)
    for kind, fewest in (("accepted", FEWEST_ACCEPTED), ("rejected", FEWEST_REJECTED)):
        count = sum(v.name.startswith(f"{kind}/") for v in declared)
        if count < fewest:
            result.faults.append(f"{count} {kind} variants, at least {fewest} are needed")
    for check in exercise.checks:
        if not any(check.id in v.fails for v in declared if v.name.startswith(REJECTED)):
            result.faults.append(f"no rejected variant fails the check {check.id}: it proves nothing")
    every = chosen_trials(exercise, "all")
    hidden = tuple(trial for trial in every if trial not in exercise.trials)
    # What is to fail in the public trials needs no hidden ones.
    until_it_fails = (exercise.trials, hidden) if hidden else (exercise.trials,)
    mutants = _mutants(exercise, result, most_mutants)
    jobs = []
    for v in declared:
        fails_in_public = v.name.startswith(REJECTED) and v.trial is None
        trials = until_it_fails if fails_in_public else (every,)
        jobs.append(Job(exercise, submitted_file(exercise, v, out), out / v.name, trials))
    for number, mutant in enumerate(mutants, 1):
        folder = out / "mutants" / str(number)
        file = completed(exercise, {exercise.file: mutant.content}, folder)
        jobs.append(Job(exercise, file, folder, until_it_fails))
    reports = pool.reports(jobs)
    for variant in declared:
        result.proofs.append(judge(exercise, variant, next(reports)))
        yield result
    for mutant in mutants:
        result.mutants.append(MutantProof(mutant, failed_in(next(reports).score)))
        yield result


def submitted_file(exercise: Exercise, variant: Variant, out: Path) -> Path:
    """Return the file to submit; that of a variant with several files lies in a folder with all of them."""
    if not exercise.files or variant.folder in (exercise.folder, exercise.twin):
        return variant.folder / exercise.file
    own = {name: path.read_bytes() for name in exercise.parts if (path := variant.folder / name).is_file()}
    return completed(exercise, own, out / variant.name / "submission")


def _mutants(exercise: Exercise, result: Verification, most: int) -> list[Mutant]:
    """Choose the mutants of the solution; record a fault for each declared equivalent that does not exist."""
    if not most:
        return []
    found = mutants_of(exercise.file, (exercise.twin / exercise.file).read_bytes())
    equivalent = equivalent_mutants(exercise)
    known = {mutant.change for mutant in found}
    result.faults += [
        f"no mutant of the solution is {each!r}, as [mutants] declares" for each in equivalent if each not in known
    ]
    return choose([mutant for mutant in found if mutant.change not in equivalent], most)


def failed_in(score: Score) -> frozenset[str]:
    """Return the ids of the failed checks."""
    return frozenset(check.spec.id for check in score.checks if not check.finding.passed)


def judge(exercise: Exercise, variant: Variant, report: Report) -> Proof:
    """Compare what a variant declares with its report."""
    failed = failed_in(report.score)
    proof = Proof(variant, failed, report)
    for check in sorted(failed - variant.fails):
        measured = next(c.finding.measured for c in report.score.checks if c.spec.id == check)
        proof.faults.append(f"fails {check}, which it must pass: {measured}")
    proof.faults += [f"passes {check}, which it must fail" for check in sorted(variant.fails - failed)]
    if not proof.faults:
        proof.faults += _trials(exercise, variant, report)
    lost = [check for check in report.score.checks if not check.finding.passed]
    hint = report.first_failed.spec.hint if report.first_failed is not None else ""
    told = " ".join([check.finding.measured for check in lost] + [each for c in lost for each in c.spec.hints])
    all_hints = report.first_failed.spec.hints if report.first_failed is not None else ()
    first = " ".join([report.score.feedback, *all_hints])
    if (length := words(report.score.diagnosis)) > MOST_FIRST:
        proof.faults.append(
            f"its first sentence has {length} words, more than {MOST_FIRST}: {report.score.diagnosis!r}"
        )
    if (length := words(f"{report.score.diagnosis} {hint}")) > MOST_OPEN:
        proof.faults.append(f"its first sentence and hint have {length} words, more than {MOST_OPEN}: {hint!r}")
    for word in variant.words:
        if word.casefold() not in first.casefold():
            where = "only further down" if word.casefold() in told.casefold() else "nowhere"
            proof.faults.append(f"its first line of feedback does not say {word!r} ({where} does it stand): {first!r}")
    return proof


def _trials(exercise: Exercise, variant: Variant, report: Report) -> Iterator[str]:
    """Yield the faults of the trials: a variant must fail in the declared ones. Students have only the public ones."""
    public = {trial.name for trial in exercise.trials}
    by_name = {trial.name: failed_in(trial.score) for trial in report.trials}
    in_public = frozenset().union(*(failed for name, failed in by_name.items() if name in public))
    if variant.name == "starter":
        for trial in report.trials:
            if trial.score.points:
                yield f"earns {trial.score.points:g} points in the trial {trial.name}; a starter earns nothing"
    elif variant.trial is None:
        for check in sorted(variant.fails - in_public):
            yield f'passes {check} in public; say trial = "..." if only a hidden trial can find it out'
    else:
        for check in sorted(in_public):
            yield f"fails {check} in public already, but declares trial = {variant.trial!r}"
        for check in sorted(variant.fails - by_name.get(variant.trial, frozenset())):
            yield f"passes {check} in the trial {variant.trial}, which must find it out"
