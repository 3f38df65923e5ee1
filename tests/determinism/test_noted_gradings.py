"""What was graded before is not graded again, and counts."""

from gz_course.tests.determinism import __main__ as determinism


def row():
    return determinism.Row("a", "01_topics", determinism.ROOT)


def test_noted_gradings_are_taken_over_but_for_one_that_was_cut(tmp_path):
    file = tmp_path / "noted.jsonl"
    line = '{"name": "a", "busy": %s, "seconds": 1.0, "score": 100, "hash": "%s"}\n'
    file.write_text(line % ("false", "x") + line % ("true", "x") + '{"name": "gone", "fault": ""}\n{"name": "a", "bu')
    same = row()
    assert determinism.take_noted([same], file) == 2
    assert same.same and (len(same.seconds[False]), len(same.seconds[True])) == (1, 1)
    file.write_text(
        line % ("false", "x") + line % ("true", "y") + '{"name": "a", "busy": true, "seconds": 1, "fault": "no"}'
    )
    other = row()
    assert determinism.take_noted([other], file) == 3
    assert not other.same and other.faults == ["no"]
    assert determinism.take_noted([row()], tmp_path / "none") == 0


def test_gradings_of_other_code_do_not_count(tmp_path, monkeypatch):
    monkeypatch.setattr(determinism, "ROOT", tmp_path)
    (tmp_path / "sim").mkdir()
    (tmp_path / "sim/x.py").write_text("1")
    before = determinism.note_file("A")
    assert determinism.note_file("A") == before != determinism.note_file("B")
    (tmp_path / "sim/x.py").write_text("2")
    assert determinism.note_file("A") != before
