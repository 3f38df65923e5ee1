"""Where reports go: what cannot be written is said before anything runs, and nothing is overwritten by mistake."""

import json
from pathlib import Path

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.report.format import formats
from gz_course.grader.report.outputs import Outputs, check_writable


def test_every_wanted_report_is_written(make_report, tmp_path):
    outputs = Outputs({name: tmp_path / "new" / name for name in formats()})
    outputs.check()
    assert list((tmp_path / "new").iterdir()) == [], "finding out leaves nothing behind"
    report = make_report()
    outputs.write(report)
    for name in formats():
        made = formats()[name].as_text(report)
        assert (tmp_path / "new" / name).read_bytes() == (made if isinstance(made, bytes) else made.encode())
    assert json.loads((tmp_path / "new/json").read_text())["score"] == 50
    assert (tmp_path / "new/html").read_text().startswith("<!doctype html>")
    assert json.loads((tmp_path / "new/gradescope").read_text())["tests"]
    assert (tmp_path / "new/junit").read_text().startswith("<?xml")


def test_what_nobody_asked_for_is_not_written(make_report, tmp_path):
    (tmp_path / "out").mkdir()
    Outputs({"junit": tmp_path / "out/only.xml"}).write(make_report())
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["only.xml"]


@pytest.mark.parametrize("name", formats())
def test_a_target_that_cannot_be_written(name, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match=r"cannot write .*file/report"):
        Outputs({name: tmp_path / "file/report"}).check()


def test_a_recording_that_cannot_be_written(tmp_path):
    with pytest.raises(UsageError, match="it is a folder"):
        Outputs().check([tmp_path])


def test_a_name_no_file_can_have(tmp_path):
    with pytest.raises(UsageError, match="cannot write"):
        check_writable(Path(f"{tmp_path}/a\0b"))
    with pytest.raises(UsageError, match="cannot write"):
        check_writable(tmp_path / ("x" * 5000))


def test_two_reports_in_one_file(tmp_path):
    with pytest.raises(UsageError, match=r"--html .* would overwrite the report of --json"):
        Outputs({"json": tmp_path / "a", "html": tmp_path / "b/../a"}).check()


def test_a_report_in_place_of_the_recording(tmp_path):
    with pytest.raises(UsageError, match=r"--html .* would overwrite a recording"):
        Outputs({"html": tmp_path / "run.rrd"}).check([tmp_path / "run.rrd"])


def test_a_report_in_place_of_the_submission(tmp_path):
    (tmp_path / "node.py").write_text("precious")
    (tmp_path / "link.json").symlink_to("node.py")
    for name in ("node.py", "link.json"):
        with pytest.raises(UsageError, match="would overwrite what is graded"):
            Outputs({"json": tmp_path / name}).check(inputs=[tmp_path / "node.py"])
    assert (tmp_path / "node.py").read_text() == "precious"


def test_a_report_of_last_time_is_overwritten(make_report, tmp_path):
    target = tmp_path / "report.json"
    target.write_text("x" * 1_000_000)
    outputs = Outputs({"json": target})
    outputs.check(inputs=[tmp_path])
    assert target.stat().st_size == 1_000_000
    outputs.write(make_report())
    assert json.loads(target.read_text())


def test_two_reports_may_go_to_one_stream():
    Outputs({"json": Path("/dev/null"), "html": Path("/dev/null")}).check()


def test_making_a_report_of_nothing_special_loads_nothing_special(course, tmp_path):
    """The HTML page's parts are imported only for those who want the page."""
    prelude = (
        "import gz_course.grader.report.outputs, gz_course.grader.report.terminal\n"
        "import atexit, sys\n"
        "heavy = lambda: sorted({'jinja2', 'markupsafe'} & set(sys.modules))\n"
        "atexit.register(lambda: print('loaded:', heavy(), file=sys.stderr))"
    )
    outcome = course("grade", "--help", prelude=prelude)
    assert outcome.stderr.strip().endswith("loaded: []"), outcome.output
