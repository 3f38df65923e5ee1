"""All questions are asked, and one that breaks does not silence the others."""

import types

import pytest

from gz_course.grader.registry import modules
from gz_course.grader.tools.doctor import checks
from gz_course.grader.tools.doctor.checkup import examine
from gz_course.grader.tools.doctor.verdict import fine


def question(name, answer):
    module = types.ModuleType(f"gz_course.grader.tools.doctor.checks.{name}")
    module.TITLE, module.examine = name.upper(), answer
    return module


def broken(error):
    def raises(probes):
        raise error

    return raises


def test_every_question_has_a_title():
    assert all(module.TITLE and module.__doc__ for module in modules(checks).values())


def test_answers_come_in_order_and_a_broken_question_is_a_failure():
    asked = [
        question("first", lambda probes: fine("well")),
        question("breaks", broken(ZeroDivisionError("planted"))),
        question("probes", lambda probes: fine(probes.run("raise OSError('no disk')"))),
        question("last", lambda probes: fine(probes.run("print('still asked')"))),
    ]
    first, breaks, probes, last = examine(60.0, asked)
    assert (first.check, first.title, first.verdict) == ("first", "FIRST", fine("well"))
    assert breaks.verdict.status == "failed" and "ZeroDivisionError: planted" in breaks.verdict.seen
    assert (probes.verdict.status, probes.verdict.seen) == ("failed", "OSError: no disk")
    assert last.as_dict() == {"check": "last", "title": "LAST", "status": "ok", "seen": "still asked", "fix": ""}


def test_an_interrupt_ends_the_probes():
    folders = []

    def hangs(probes):
        folders.append(probes.folder)
        return fine(probes.run("import threading; threading.Event().wait()"))

    with pytest.raises(KeyboardInterrupt):
        examine(60.0, [question("interrupted", broken(KeyboardInterrupt())), question("hangs", hangs)])
    assert [folder for folder in folders if folder.exists()] == []
