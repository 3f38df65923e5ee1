"""The table of attacks: no verdict is better than what its test has found."""

from types import SimpleNamespace

from .attack_table import place_of, print_table

NO_ATTACKS = True


def report(row, level, user, outcome="passed", when="call", **properties):
    told = [("attack", (row, level, user)), *properties.items()]
    words = {word: word == outcome for word in ("passed", "failed", "skipped")}
    return SimpleNamespace(user_properties=told, when=when, **words)


def lines(*reports):
    written = []
    print_table(written.append, reports)
    return written


def test_a_failed_test_is_a_breach_and_what_was_left_stands_behind_it():
    told = lines(
        report("fork bomb", "A", "root", left=" 0/0/0"),
        report("fork bomb", "A", "root", when="teardown"),
        report("fork bomb", "B", "user", "failed", left=" 2/0/0", verdict="contained"),
        report("fork bomb", "C", "user", verdict="documented"),
        report("spoof", "A", "root", "failed", when="setup"),
        report("spoof", "B", "user", "skipped", when="setup"),
    )
    assert told[1].split() == ["A", "root", "B", "user", "C", "user"]
    assert told[2].split() == ["fork", "bomb", "contained", "0/0/0", "BREACH", "2/0/0", "documented"]
    assert told[3].split() == ["spoof", "BREACH", "skipped", "-"]
    assert told[4] == "2 attacks: 1 contained, 1 documented, 2 BREACH, 1 skipped"


def test_one_column_is_no_table():
    assert lines(report("fork bomb", "A", "root"), report("spoof", "A", "root")) == []


def test_a_level_a_worker_or_neither_gives_the_column():
    def item(name, **params):
        return SimpleNamespace(name=name, callspec=SimpleNamespace(params=params, id="x"))

    assert place_of(item("test_an_attack[x]", worker=("B", 61_000), case="fork_bomb")) == ("fork bomb", "B", "user")
    assert place_of(item("test_no_file_is_opened[x]", level="C"))[:2] == ("no file is opened", "C")
    assert place_of(SimpleNamespace(name="test_it"))[:2] == ("it", "A")
