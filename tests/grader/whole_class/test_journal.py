"""The journal survives being cut at any byte: what was whole is kept, what was torn is done again."""

import json

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.whole_class.journal import JOURNAL, Journal

RESULTS = {f"key{n}": {"score": n, "student": "é\n" * n, "folder": str(n % 3)} for n in range(4)}


@pytest.fixture
def written(tmp_path):
    with Journal(tmp_path) as journal:
        for key, result in RESULTS.items():
            journal.add(key, result)
    return tmp_path / JOURNAL


def test_what_was_added_is_there_again(written):
    with Journal(written.parent) as journal:
        assert journal.done == RESULTS


def test_of_two_results_in_one_folder_the_last_has_it(written):
    with Journal(written.parent) as journal:
        assert [journal.current(key) for key in RESULTS] == [None, RESULTS["key1"], RESULTS["key2"], RESULTS["key3"]]
        journal.add("key0", RESULTS["key0"])
        assert journal.current("key0") and not journal.current("key3")


def test_every_line_is_a_result_of_its_own(written):
    assert [json.loads(line)["key"] for line in written.read_text().splitlines()] == list(RESULTS)


def test_cut_at_every_byte(written):
    data = written.read_bytes()
    for size in range(len(data) + 1):
        written.write_bytes(data[:size])
        whole = data[:size].count(b"\n")
        with Journal(written.parent) as journal:
            assert list(journal.done) == list(RESULTS)[:whole]
            journal.add("more", {"score": 1, "folder": "x"})
        with Journal(written.parent) as journal:
            assert list(journal.done) == [*list(RESULTS)[:whole], "more"], f"cut at {size}"


@pytest.mark.parametrize("junk", [b"\0\0\0\0\n", b"[]\n", b'{"key": 1}\n', b"\xff\xfe\n"])
def test_a_line_that_a_disk_has_spoilt_is_done_again(written, junk):
    lines = written.read_bytes().splitlines(keepends=True)
    written.write_bytes(lines[0] + junk + lines[2])
    with Journal(written.parent) as journal:
        assert list(journal.done) == ["key0", "key2"]


def test_only_one_at_a_time(tmp_path):
    with Journal(tmp_path), pytest.raises(UsageError, match="another course grade-all"):
        Journal(tmp_path)
    Journal(tmp_path).close()


def test_a_result_is_on_disk_when_add_returns(tmp_path, monkeypatch):
    synced = []
    with Journal(tmp_path) as journal:
        monkeypatch.setattr("os.fsync", lambda fd: synced.append((tmp_path / JOURNAL).read_bytes()))
        journal.add("key", {"score": 1, "folder": "x"})
    assert len(synced) == 1 and synced[0].endswith(b"\n")
