"""The table of worlds and the program that compares with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from gz_course.tests.worlds import table
from gz_course.tests.worlds.__main__ import compare, main, named, worlds_in
from gz_course.tests.worlds.table import Outcome


def test_the_table_is_read_and_written_alike(tmp_path: Path) -> None:
    worlds = table.read()
    assert len(worlds) > 150 and worlds["examples/worlds/empty.sdf"] == Outcome("loads")
    copy = tmp_path / "table.txt"
    table.write(worlds, copy)
    assert copy.read_text() == table.TABLE.read_text() and table.read(copy) == worlds
    copy.write_text("a.sdf: runs\n")
    with pytest.raises(ValueError, match=r"table.txt:1: expected 'NAME: OUTCOME'"):
        table.read(copy)


def test_sentences_have_no_places() -> None:
    said = ["/a/b/w.sdf:12: the include is skipped: /a/b/m", "/a/b/w.sdf:14: the include is skipped: /a/b/m"]
    assert table.outcome("warns", said, {"/a/b": "DIR"}) == Outcome("warns", ("the include is skipped: DIR/m",))


def test_what_differs() -> None:
    wanted, found = Outcome("warns", ("one", "two")), Outcome("refused", ("two", "three"))
    lines = list(compare("w.sdf", found, wanted))
    assert lines == ["differs: w.sdf: refused (table: warns)", "    + three", "    - one"]
    assert not list(compare("w.sdf", wanted, wanted))
    for unknown in (None, Outcome("untried")):
        assert next(compare("w.sdf", found, unknown)).startswith("not in the table yet: w.sdf: refused")
    known = {"examples/worlds/empty.sdf": wanted, "test/worlds/empty.sdf": wanted, "test/worlds/one.sdf": wanted}
    assert named("one.sdf", known) == "test/worlds/one.sdf"
    assert named("empty.sdf", known) == "empty.sdf" and named("test/worlds/empty.sdf", known) == "test/worlds/empty.sdf"


def test_which_worlds_are_tried(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("examples/worlds/a.sdf", "test/worlds/deep/b.world", "tutorials/c.sdf", "examples/worlds/d.txt"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    assert list(worlds_in(tmp_path)) == ["examples/worlds/a.sdf", "test/worlds/deep/b.world"]
    assert list(worlds_in(tmp_path / "tutorials")) == ["c.sdf"]
    with pytest.raises(SystemExit) as end:
        main([str(tmp_path / "nothing")])
    assert end.value.code == 2 and "there is no world" in capsys.readouterr().err


@pytest.mark.proof
def test_a_folder_of_worlds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "good.sdf").write_text("<sdf version='1.10'><world name='w'/></sdf>")
    (tmp_path / "bad.sdf").write_text("<sdf version='1.10'><world/></sdf>")
    found = tmp_path / "table.txt"
    assert main([str(tmp_path), "--table", str(found), "--write"]) == 0
    assert found.read_text() == "bad.sdf: refused\n    <world> needs a name attribute\ngood.sdf: loads\n"
    assert main([str(tmp_path), "--table", str(found)]) == 0
    (tmp_path / "good.sdf").write_text("words<sdf version='1.10'><world name='w'/></sdf>")
    assert main([str(tmp_path), "--table", str(found)]) == 1
    assert "differs: good.sdf: warns (table: loads)" in capsys.readouterr().out
