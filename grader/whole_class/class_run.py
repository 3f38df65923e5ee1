"""The grading of a class: read each submission, grade it unless the journal has its result, store the result.

`commands/grade_all.py` calls `ClassRun.grade`, which grades in threads here or on Dask's workers; the gradebook is
written from the journal. A failure of the machine or the grader is retried and finally listed, never scored; a
student's own failure is final.
"""

from __future__ import annotations

import dataclasses
import os
import shutil
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gz_course.grader.errors import InfrastructureError, RefusedError, UnreadableError, UsageError
from gz_course.grader.exercise import Exercise, bundle
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.grader.printable import shown
from gz_course.grader.process.temporary_folder import TemporaryFolder, sweep
from gz_course.grader.run.sandbox import AUTO, LEVELS, check_jobs, choose, level_module
from gz_course.grader.submission.intake import Selection
from gz_course.grader.whole_class.attempts import UNGRADED, attempt_folder, earlier_attempts, keep_earlier, move
from gz_course.grader.whole_class.dask_cluster import Needs, dask_executor
from gz_course.grader.whole_class.final import Final
from gz_course.grader.whole_class.found import Found
from gz_course.grader.whole_class.grading import OF_REPORT, REPORT, Graded, Job, Setup, grade_one, gradings_end_here
from gz_course.grader.whole_class.identity import key_of, made_alike
from gz_course.grader.whole_class.journal import JOURNAL, Journal, Results, read_results
from gz_course.grader.whole_class.kept import free_recordings, is_kept, with_notes, without_recordings
from gz_course.grader.whole_class.late_policy import read_policy
from gz_course.grader.whole_class.overview import Progress, write_overview
from gz_course.grader.whole_class.plan import Plan, make_plan
from gz_course.grader.whole_class.students_folder import BESIDE, PART, folder_name
from gz_course.grader.whole_class.unread import unread_files
from gz_course.grader.whole_class.versions import versions

LOOK = 2.0  # [s] between two checks that the workers still exist
ATTEMPTS = 3  # at one submission, if the student is not at fault
HOPELESS = 6  # failures in a row, before any success, after which the run ends
# [s], [s] and wall seconds per simulated second of a grading. Its own watchdog ends what takes too much; this is for a
# grading that hangs nevertheless.
START_UP, PER_TRIAL, WALL_FACTOR = 600.0, 600.0, 60.0

Result = dict[str, Any]


@dataclass
class ClassRun:
    """The grading of one class: what, into which folder, and how.

    `reports` are formats besides JSON; `keep` says whose recordings stay (`kept.py`); `submitted` returns when
    something was handed in, as an ISO time.
    """

    exercise: Exercise
    out: Path
    seed: int = 0
    trials: str = "public"
    reports: tuple[str, ...] = ()
    sandbox: str = "auto"
    demand: str | None = None
    keep: str = "all"
    submitted: Callable[[Found], str | None] = lambda found: None

    def __post_init__(self) -> None:
        files, choice = bundle.bundle(self.exercise, self.trials)
        trials = chosen_trials(self.exercise, self.trials)
        seconds = sum(PER_TRIAL + WALL_FACTOR * (trial.duration or self.exercise.duration) for trial in trials)
        options: tuple[str, ...] = ("--seed", str(self.seed), "--trials", choice, "--sandbox", self.sandbox)
        options += ("--demand", self.demand) if self.demand else ()
        self.setup = Setup(self.exercise.name, files, options, self.reports, START_UP + seconds, None)
        self._same = made_alike(self.exercise.name, files, options, self.reports)
        self._made_with = {"options": options, "reports": self.reports, "trials": self.trials}
        self._hopeless = 0
        self._attempts = False

    def grade(
        self,
        found: Iterable[Found],
        told: Callable[[Result, bool], None],
        *,
        jobs: int | None = 1,
        dask: str | None = None,
    ) -> list[Result]:
        """Grade all submissions and write the gradebook; return the results in the order of `found`.

        `jobs` gradings run at a time (None: one a core, or one where they are not kept apart), or as many as there are
        workers at the Dask address. `told(result, anew)` is
        called after each; `anew` is False if an earlier run had graded it. Raises UsageError if the folder cannot be
        used, InfrastructureError if nothing can be graded here.
        """
        found = list(found)
        rules = Final(self.exercise, self.out, ((each.student, each.id) for each in found))  # before anything is graded
        self._attempts = bool(rules.attempts)
        with ExitStack() as stack:
            journal = stack.enter_context(self._open())
            sweep()  # removes what a killed run left
            local = dask is None
            if local:
                executor, slots, gone = self._here(jobs, stack)
            else:
                needs = Needs(versions(), self.sandbox, self.demand)
                executor, slots, gone = stack.enter_context(dask_executor(dask or "", self._check_slots, needs))
            results: dict[str, Result] = {}
            ungraded: set[str] = set()  # students of whom an earlier attempt could not be graded
            todo = deque((each, 1) for last in found for each in self._attempts_of(last))
            last = {id(each) for each in found}
            progress = Progress(self.out, self.exercise, rules, [self._blank(each) for each in found])
            running: dict[Future[Graded], tuple[Found, Result, str, int]] = {}
            stack.callback(lambda: [future.cancel() for future in running])
            while todo or running:
                while todo and len(running) < slots() + 1:  # one more than can run, so that no worker is idle
                    each, attempt = todo.popleft()
                    result, job, anew = self._prepare(each, journal, earlier=id(each) not in last)
                    if job is None and id(each) in last:
                        results[each.student] = result
                        progress.add(result, anew=anew)
                        told(result, anew)
                    elif job is None:
                        continue
                    else:
                        running[self._submit(executor, job)] = (each, result, job.key, attempt)
                finished = wait(running, LOOK, FIRST_COMPLETED).done if running else set()
                if not finished and gone():
                    running.clear()  # no longer needed: nobody is left to be told of a cancellation
                    raise InfrastructureError("the Dask scheduler is gone; start it, and the same command goes on")
                for future in finished:
                    each, result, key, attempt = running.pop(future)
                    graded = _outcome(future)
                    self._watch(graded, attempt)
                    if graded.report is None and attempt < ATTEMPTS:
                        todo.append((each, attempt + 1))
                        continue
                    self._keep(result, graded, key, journal)
                    if id(each) in last:
                        results[each.student] = result
                        progress.add(result, anew=True)
                        told(result, True)
                    elif graded.report is None:
                        ungraded.add(each.student)
            ordered = [results[each.student] | {UNGRADED: each.student in ungraded} for each in found]
            return write_overview(self.out, self.exercise, ordered, self.reports, earlier_attempts(journal))

    def _attempts_of(self, found: Found) -> tuple[Found, ...]:
        """Return the attempts of a student that are graded, the last one last."""
        return (*found.earlier, found) if self._attempts else (found,)

    def plan(self, found: Iterable[Found], at_once: int | None) -> Plan:
        """Return what grading these submissions will take; reads the journal and writes nothing."""
        policy = read_policy(self.out)
        self._attempts = policy is not None and bool(policy.attempts)
        submissions = [each for last in found for each in self._attempts_of(last)]
        journal = read_results(self.out)
        known = {result["student"] for result in journal.all()}
        done = sum(each.student in known and self._done(each, journal) is not None for each in submissions)
        return make_plan(
            self.out, journal, len(submissions), done, at_once=at_once, keep=self.keep,
            trials=len(chosen_trials(self.exercise, self.trials)), most=self.exercise.max_score,
        )  # fmt: skip

    def _done(self, found: Found, journal: Results) -> Result | None:
        """Return the result of a submission from an earlier run, None if it is to be graded."""
        try:
            _, what = _read(found)
        except Exception:  # it is read once more, and told, when it is its turn
            return None
        done = journal.current(key_of(self._made_of(found, what), self._same))
        return done if done is not None and self._has_files(done) else None

    @staticmethod
    def _made_of(found: Found, what: list[str]) -> list[str]:
        return [found.student, found.id, found.source, found.platform, *what]

    def _submit(self, executor: Executor, job: Job) -> Future[Graded]:
        try:
            return executor.submit(grade_one, self.setup, job)
        except Exception as error:  # a lost Dask scheduler, or no memory for a thread
            told = shown(f"{type(error).__name__}: {error}")
            raise InfrastructureError(f"no more gradings can be started: {told}; the same command goes on") from None

    def _open(self) -> Journal:
        """Make the folder of the class if necessary, and open its journal."""
        try:
            self.out.mkdir(parents=True, exist_ok=True)
            found = {path.name for path in self.out.iterdir()}
        except OSError as error:
            raise UsageError(f"{self.out} cannot be used: {error.strerror}") from None
        if found - BESIDE and JOURNAL not in found:
            raise UsageError(f"{self.out} is not empty and not from an earlier run; give a folder that is new or empty")
        journal = Journal(self.out)
        for part in self.out.glob(f"{PART}*"):
            shutil.rmtree(part, ignore_errors=True)
        return journal

    def _check_slots(self, most: int) -> None:
        """Raise UsageError if a machine with Dask's workers runs more gradings at a time than its level allows."""
        weakest = self.sandbox if self.sandbox != AUTO else self.demand or LEVELS[-1]
        check_jobs(weakest, most)

    def level_and_jobs(self, jobs: int | None) -> tuple[str, int]:
        """Return the sandbox's level here and how many gradings run at a time.

        Raises UsageError if the level does not keep as many apart, InfrastructureError if no demanded level works.
        """
        level = choose(self.sandbox, self.demand)
        if jobs is None:
            jobs = len(os.sched_getaffinity(0)) if level_module(level).PRIVATE_NETWORK else 1
        check_jobs(level, jobs)
        return level, jobs

    def _here(self, jobs: int | None, stack: ExitStack) -> tuple[Executor, Callable[[], int], Callable[[], bool]]:
        """Return threads of this process, each of which waits for one grading."""
        level, jobs = self.level_and_jobs(jobs)  # once, so that all submissions get the same
        try:
            folder = stack.enter_context(TemporaryFolder("course-class-"))
        except OSError as error:
            raise InfrastructureError(f"no temporary folder: {error.strerror}") from None
        options = (*self.setup.options, "--sandbox", level)
        self.setup = dataclasses.replace(self.setup, folder=str(folder), options=options)
        executor = ThreadPoolExecutor(jobs)
        stack.callback(executor.shutdown, cancel_futures=True)
        stack.enter_context(gradings_end_here())
        return executor, lambda: jobs, lambda: False

    def _prepare(self, found: Found, journal: Journal, *, earlier: bool = False) -> tuple[Result, Job | None, bool]:
        """Read a submission and return its result, and its job if it is to be graded.

        `earlier`: it is not the last attempt of its student. The third value is whether the result is new; if not, an
        earlier run had graded it.
        """
        result = self._blank(found)
        try:
            chosen, what = _read(found)
        except UnreadableError as error:
            return result | {"diagnosis": shown(str(error))}, None, True
        except Exception as error:  # a submission that cannot be read must not end the run
            return result | {"diagnosis": shown(f"not read: {type(error).__name__}: {error}")}, None, True
        result |= {"made_of": self._made_of(found, what), "made_with": self._made_with}
        key = key_of(result["made_of"], self._same)
        if chosen is not None and chosen.notes:
            result["notes"] = list(chosen.notes)
        if earlier:
            result["folder"] = attempt_folder(found.student, key)
        done = journal.current(key)
        if done is not None and self._has_files(done):
            if not is_kept(self.keep, done["score"], self.exercise.max_score):
                done = self._freed(done, key, journal)
            if done["folder"] != result["folder"]:
                done = move(self.out, journal, key, done, result["folder"])
            return done | {name: result[name] for name in ("submitted", "notes") if name in result}, None, False
        if self._attempts and not earlier:
            keep_earlier(self.out, journal, found.student, what[1])
        if chosen is not None:
            result["sha256"] = what[1]
            return result, Job(found.student, key, found.source, chosen.main, chosen.files), True
        result |= {"score": 0, "points": {check.id: 0 for check in self.exercise.checks}}
        result |= {"outcome": what[0], "diagnosis": what[1]}
        self._store(result, unread_files(self.exercise, result, self.reports))
        journal.add(key, result)
        return result, None, True

    def _freed(self, done: Result, key: str, journal: Journal) -> Result:
        """Return a result of an earlier run without the recordings that it kept and that this run does not keep."""
        try:
            freed = free_recordings(self.out / done["folder"])
        except OSError as error:
            raise InfrastructureError(f"{self.out / done['folder']} cannot be written: {error.strerror}") from None
        if freed:
            done = done | {"recordings": False}
            journal.add(key, done)
        return done

    def _has_files(self, result: Result) -> bool:
        """Return whether the folder of a result still has its report, and its recordings if they are to be kept."""
        score = result["score"]
        missing = not result.get("recordings", True) and is_kept(self.keep, score, self.exercise.max_score)
        return not missing and (self.out / result["folder"] / REPORT).is_file()

    def _blank(self, found: Found) -> Result:
        return {
            "student": found.student,
            "id": found.id,
            "submission": found.source,
            "score": None,
            "outcome": "infra",
            "points": {},
            "diagnosis": "",
            "sha256": "",
            "truth_sha256": "",
            "folder": folder_name(found.student),
            "platform": found.platform,
            "submitted": self.submitted(found),
        }

    def _watch(self, graded: Graded, attempt: int) -> None:
        """Raise InfrastructureError if nothing can be graded at all, instead of trying every submission three times."""
        if graded.report is not None:
            self._hopeless = -1
        elif self._hopeless >= 0 and attempt == 1:
            self._hopeless += 1
            if self._hopeless >= HOPELESS:
                raise InfrastructureError(
                    f"nothing can be graded here: {HOPELESS} gradings in a row failed, the last because "
                    f"{graded.fault}; no student loses points; `course doctor` may show the cause"
                )

    def _keep(self, result: Result, graded: Graded, key: str, journal: Journal) -> None:
        report = graded.report
        if report is None:
            result["diagnosis"] = f"not graded: {graded.fault}"
            return
        result |= {name: report[name] for name in OF_REPORT}
        result["leaderboard"] = report.get("leaderboard", [])
        result["points"] = {check["id"]: check["points"] for check in report["checks"]}
        files = graded.files
        if not is_kept(self.keep, report["score"], self.exercise.max_score):
            files = without_recordings(files)
            result["recordings"] = False
        self._store(result, with_notes(files, result.get("notes", ())))
        journal.add(key, result)

    def _store(self, result: Result, files: dict[str, bytes]) -> None:
        """Store a student's files in their folder, all or none, before the journal lists them."""
        target, part = self.out / result["folder"], self.out / f"{PART}{result['folder'].replace('/', '-')}"
        try:
            part.mkdir()
            target.parent.mkdir(exist_ok=True)
            for name, data in files.items():
                with (part / name).open("wb") as stream:
                    stream.write(data)
                    stream.flush()
                    os.fsync(stream.fileno())
            if target.exists():
                shutil.rmtree(target)
            part.rename(target)
        except OSError as error:
            raise InfrastructureError(f"{target} cannot be written: {error.strerror}; nothing is lost") from None


def _read(found: Found) -> tuple[Selection | None, list[str]]:
    """Return a submission, None if it is the student's fault that there is none, and what identifies its content.

    Raises what else reading raises.
    """
    try:
        chosen = found.read()
    except UnreadableError:
        raise
    except UsageError as error:
        outcome = "protocol" if isinstance(error, RefusedError) else "student_error"
        return None, [outcome, shown(str(error))]
    return chosen, [chosen.main, bundle.digest(chosen.files)]


def _outcome(future: Future[Graded]) -> Graded:
    """Return the outcome of a grading, including one whose worker died."""
    try:
        return future.result()
    except CancelledError:
        return Graded(None, fault="it was cancelled")
    except Exception as error:  # a worker that died or a broken connection, never the student's fault
        return Graded(None, fault=shown(f"{type(error).__name__}: {error}"))
