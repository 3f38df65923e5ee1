"""The proof of an exercise: everything it declares is graded and compared; `course verify` prints the result.

Solution and accepted variants earn full marks in every trial, the starter nothing in any; each rejected variant loses
exactly what it declares, in the public trials or in the hidden one that it names, with the declared feedback, and no
more points than one misconception costs (`grader/score/consequences.py`), unless nothing runs at all. A check
that no rejected variant fails proves nothing and is a fault. Then the solution is changed in one place at a time
(`mutants.py`): a mutant that keeps full marks is a survivor, which is a warning.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from gz_course.grader.edits import Edit, edits_of
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.grader.report.report import Report
from gz_course.grader.score.consequences import MOST_FOR_ONE
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
from gz_course.grader.verify.kept import Kept
from gz_course.grader.verify.mutants import MOST, choose
from gz_course.sim.did_you_mean import did_you_mean

REJECTED = "rejected/"

NEARLY_ALL = 0.75  # of all points, that a variant loses in which nothing runs
FEWEST_RUNGS = 4  # checks; the points of fewer are no ladder
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

    mutant: Edit
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
    def survivors(self) -> list[Edit]:
        """The mutants that no check noticed."""
        return [proof.mutant for proof in self.mutants if not proof.failed]

    def killed_by(self, check: str) -> tuple[int, int]:
        """Return how many rejected variants and how many mutants fail a check."""
        rejected = [proof for proof in self.proofs if proof.variant.name.startswith(REJECTED)]
        return sum(check in proof.failed for proof in rejected), sum(check in m.failed for m in self.mutants)


@dataclass(frozen=True)
class Plan:
    """What a verification will grade. `faults` are those of the exercise as a whole, which show without a run."""

    exercise: Exercise
    variants: list[Variant]
    mutants: list[Edit]
    faults: list[str]

    def __len__(self) -> int:
        return len(self.variants) + len(self.mutants)


def plan(exercise: Exercise, most_mutants: int = MOST, only: str = "") -> Plan:
    """Read what an exercise declares; `only` names the one variant to grade, such as `rejected/never_stops`.

    Raises ManifestError if the halves do not agree, UsageError if no variant has that name.
    """
    declared = variants(exercise)
    if only:
        found = [variant for variant in declared if variant.name == only.strip("/")]
        if not found:
            hint = did_you_mean(only, [variant.name for variant in declared], listing="known")
            raise UsageError(f"{exercise.name} has no variant {only!r}{hint}")
        return Plan(exercise, found, [], [])
    faults = []
    for kind, fewest in (("accepted", FEWEST_ACCEPTED), ("rejected", FEWEST_REJECTED)):
        count = sum(v.name.startswith(f"{kind}/") for v in declared)
        if count < fewest:
            faults.append(f"{count} {kind} variants, at least {fewest} are needed")
    for check in exercise.checks:
        if not any(check.id in v.fails for v in declared if v.name.startswith(REJECTED)):
            faults.append(f"no rejected variant fails the check {check.id}: it proves nothing")
    return Plan(exercise, declared, _mutants(exercise, faults, most_mutants), faults)


def planned_jobs(planned: Plan, out: Path, kept: Kept | None = None) -> list[Job]:
    """Return the gradings of a plan in its order; the recordings go to the folder `out`, the reports to `kept`."""
    exercise = planned.exercise
    every = chosen_trials(exercise, "all")
    hidden = tuple(trial for trial in every if trial not in exercise.trials)
    # What is to fail in the public trials needs no hidden ones.
    until_it_fails = (exercise.trials, hidden) if hidden else (exercise.trials,)
    jobs = []
    for v in planned.variants:
        fails_in_public = v.name.startswith(REJECTED) and v.trial is None
        trials = until_it_fails if fails_in_public else (every,)
        jobs.append(Job(exercise, submitted_file(exercise, v, out), out / v.name, trials))
    for number, mutant in enumerate(planned.mutants, 1):
        folder = out / "mutants" / str(number)
        file = completed(exercise, {exercise.file: mutant.content}, folder)
        jobs.append(Job(exercise, file, folder, until_it_fails))
    return jobs if kept is None else [replace(job, kept=_place(kept, job)) for job in jobs]


def _place(kept: Kept, job: Job) -> Path:
    beside = {name: job.file.parent / name for name in job.exercise.parts}
    submitted = {name: path.read_bytes() for name, path in beside.items() if path.is_file()}
    return kept.place({"out": str(job.out.name).encode()} | submitted, job.trials)


def verify(planned: Plan, jobs: Sequence[Job], pool: Pool) -> Iterator[Verification]:
    """Grade every variant and mutant of a plan; yield the growing result after each, the complete one last."""
    exercise = planned.exercise
    result = Verification(exercise, faults=list(planned.faults))
    reports = pool.reports(jobs)
    for variant in planned.variants:
        result.proofs.append(judge(exercise, variant, next(reports)))
        yield result
    for mutant in planned.mutants:
        result.mutants.append(MutantProof(mutant, failed_in(next(reports).score)))
        yield result


def submitted_file(exercise: Exercise, variant: Variant, out: Path) -> Path:
    """Return the file to submit; that of a variant with several files lies in a folder with all of them."""
    if not exercise.files or variant.folder in (exercise.folder, exercise.twin):
        return variant.folder / exercise.file
    own = {name: path.read_bytes() for name in exercise.parts if (path := variant.folder / name).is_file()}
    return completed(exercise, own, out / variant.name / "submission")


def _mutants(exercise: Exercise, faults: list[str], most: int) -> list[Edit]:
    """Choose the mutants of the solution; add a fault for each declared equivalent that does not exist."""
    if not most:
        return []
    found = edits_of(exercise.file, (exercise.twin / exercise.file).read_bytes())
    equivalent = equivalent_mutants(exercise)
    known = {mutant.change for mutant in found}
    faults += [
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
    proof.faults += _ladder(variant, report) if len(exercise.checks) >= FEWEST_RUNGS else []
    lost = [check for check in report.score.checks if not check.finding.passed]
    hint = report.first_failed.spec.hint if report.first_failed is not None else ""
    told = " ".join([check.finding.measured for check in lost] + [each for c in lost for each in c.spec.hints])
    first = f"{report.score.feedback} {hint}"
    if (length := words(report.score.diagnosis)) > MOST_FIRST:
        proof.faults.append(
            f"its first sentence has {length} words, more than {MOST_FIRST}: {report.score.diagnosis!r}"
        )
    if (length := words(f"{report.score.diagnosis} {hint}")) > MOST_OPEN:
        proof.faults.append(f"its first sentence and hint have {length} words, more than {MOST_OPEN}: {hint!r}")
    for word in variant.words:
        if word.casefold() not in first.casefold():  # where a sentence is cut, the next one gets a capital letter
            where = "only further down" if word.casefold() in told.casefold() else "nowhere"
            proof.faults.append(f"its first line of feedback does not say {word!r} ({where} does it stand): {first!r}")
    return proof


def _ladder(variant: Variant, report: Report) -> Iterator[str]:
    """Yield a fault if a rejected variant costs too much for one misconception, or too little for nothing that runs."""
    if not variant.name.startswith(REJECTED):
        return
    lost = report.max_score - report.score.points
    if variant.nothing_runs:
        if lost < NEARLY_ALL * report.max_score:
            yield f"loses {lost:g} of {report.max_score:g} points: more runs than nothing_runs says"
    elif lost > MOST_FOR_ONE * report.max_score:
        yield f"loses {lost:g} of {report.max_score:g} points; one misconception costs at most {MOST_FOR_ONE:.0%}"


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
