"""What the recorder writes is what the reader returns, from finished and from unfinished files."""

import math
import random

import numpy as np
import psutil
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import UsageError
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import BLOCK_NS, Recorder

pytestmark = pytest.mark.usefixtures("without_blueprint")

FINITE = st.floats(allow_nan=False, allow_infinity=True)


@pytest.fixture
def recorder(tmp_path):
    made = Recorder(tmp_path / "deep" / "er" / "run.rrd", "robot")
    yield made
    if made.part.exists():
        made.abandon()


def test_signals_arrays_lines_and_properties_come_back(recorder):
    for second in range(12):  # over more than one block
        recorder.set_time(second * 1_000_000_000)
        recorder.scalar("truth/robot/x", second / 3)
        recorder.array("topics/scan/ranges", [second, math.inf, -1.0])
        recorder.text("log/student", f"line {second}", "WARN" if second % 2 else "INFO")
    recorder.properties("run", exercise="made", seed=3, duration=8.0)
    recorder.close()
    recording = Recording(recorder.path)
    signal = recording.signal("truth/robot/x")
    assert signal.times.tolist() == [second * 1_000_000_000 for second in range(12)]
    assert signal.values.tolist() == [second / 3 for second in range(12)], "in double precision"
    times, rows = recording.arrays("topics/scan/ranges")
    assert times.tolist() == signal.times.tolist()
    assert rows[5].tolist() == [5, math.inf, -1.0]
    lines = recording.lines("log/student")
    assert [(line.time_ns, line.text, line.level) for line in lines[:2]] == [
        (0, "line 0", "INFO"),
        (1_000_000_000, "line 1", "WARN"),
    ]
    assert recording.properties("run") == {"exercise": "made", "seed": 3, "duration": 8.0}
    assert recording.end_ns == 11_000_000_000
    assert "truth/robot/x" in recording.signals() and recording.has("truth/robot/x")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=25)
@given(st.dictionaries(st.integers(0, 20 * BLOCK_NS), FINITE, min_size=1, max_size=60))
def test_any_samples_come_back_bit_for_bit(tmp_path, samples):
    path = tmp_path / f"{random.getrandbits(64):x}.rrd"
    with Recorder(path, "robot") as recorder:
        for time, value in sorted(samples.items()):
            recorder.set_time(time)
            recorder.scalar("a/b", value)
    signal = Recording(path).signal("a/b")
    assert signal.times.tolist() == sorted(samples)
    assert signal.values.tobytes() == np.array([samples[t] for t in sorted(samples)]).tobytes()


def test_samples_of_one_moment_keep_their_order(recorder):
    for number in range(100):
        recorder.scalar("a", number)
        recorder.text("log/student", str(number))
    recorder.close()
    recording = Recording(recorder.path)
    assert recording.signal("a").values.tolist() == list(range(100))
    assert [line.text for line in recording.lines("log/student")] == [str(n) for n in range(100)]


def test_nan_is_left_out(recorder):
    recorder.scalar("a", math.nan)
    recorder.set_time(1)
    recorder.scalar("a", 1.0)
    recorder.close()
    assert Recording(recorder.path).signal("a").times.tolist() == [1]


def test_an_unfinished_file_reads_like_a_finished_one(recorder):
    recorder.set_time(5)
    recorder.scalar("a", 1.0)
    recorder.text("log/student", "hello")
    recorder.properties("run", exercise="made")
    recorder.flush()
    assert recorder.part.name == "run.rrd.part" and not recorder.path.exists()
    recording = Recording(recorder.part)
    assert recording.signal("a").values.tolist() == [1.0]
    assert recording.lines("log/student")[0].text == "hello"
    assert recording.properties("run") == {"exercise": "made"}


def test_after_a_crash_all_but_the_last_block_is_there(recorder):
    for second in range(12):
        recorder.set_time(second * 1_000_000_000)
        recorder.scalar("a", second)
    recorder.stream.flush()
    # Nobody called `flush` since 10 s: what a killed grader leaves behind.
    assert Recording(recorder.part).signal("a").values.tolist() == list(range(10))


def test_closing_gives_the_file_its_name_and_an_error_removes_it(tmp_path):
    path = tmp_path / "run.rrd"
    with Recorder(path, "robot"):
        assert not path.exists()
    assert path.is_file() and not path.with_suffix(".rrd.part").exists()
    other = tmp_path / "other.rrd"
    with pytest.raises(RuntimeError), Recorder(other, "robot"):
        raise RuntimeError
    assert list(tmp_path.iterdir()) == [path]


def test_one_begun_stays_open_and_leaves_nothing_if_interrupted(tmp_path, monkeypatch):
    with Recorder.begun(tmp_path / "run.rrd", "robot") as recorder:
        recorder.scalar("a", 1.0)
    assert recorder.part.exists()
    recorder.abandon()
    with pytest.raises(KeyboardInterrupt), Recorder.begun(tmp_path / "run.rrd", "robot"):
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []

    def interrupted(*_):
        assert (tmp_path / "run.rrd.part").exists()
        raise KeyboardInterrupt

    # While it is made: its file is there already.
    monkeypatch.setattr("gz_course.grader.record.recorder.defaultdict", interrupted)
    with pytest.raises(KeyboardInterrupt), Recorder.begun(tmp_path / "run.rrd", "robot"):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_new_run_replaces_the_recording_of_the_old_one(tmp_path):
    path = tmp_path / "run.rrd"
    for value in (1.0, 2.0):
        with Recorder(path, "robot") as recorder:
            recorder.scalar("a", value)
    assert Recording(path).signal("a").values.tolist() == [2.0]


def test_recordings_that_are_done_keep_no_threads(tmp_path):
    def threads_after(name):
        with Recorder(tmp_path / f"{name}.rrd", "robot") as recorder:
            recorder.text("/log/student", "hello")
        del recorder
        return psutil.Process().num_threads()

    first, *others = [threads_after(n) for n in range(5)]
    assert max(others) <= first


def test_clouds_may_be_empty(recorder):
    recorder.points("/world/scan", np.empty((0, 3)))
    recorder.set_time(1)
    recorder.points("/world/scan", np.ones((2, 3)))
    recorder.set_time(2)
    recorder.points("/world/scan", np.empty((0, 3)))
    recorder.close()
    assert Recording(recorder.path).end_ns == 2


@pytest.mark.parametrize("text", ["käse ☃ 🤖", "a\0b", "\x1b[31m", "x" * 100_000, "\ufffd", "</a>&"])
def test_any_text_comes_back(recorder, text):
    recorder.text("log/student", text)
    recorder.properties("run", text=text)
    recorder.close()
    recording = Recording(recorder.path)
    assert recording.lines("log/student")[0].text == text
    assert recording.properties("run")["text"] == text


def test_what_was_never_recorded_is_empty(recorder):
    recorder.scalar("a", 1.0)
    recorder.close()
    recording = Recording(recorder.path)
    assert len(recording.signal("b")) == 0 and not recording.has("b")
    assert recording.arrays("b")[1] == [] and recording.lines("log/student") == []
    assert recording.properties("run") == {} and recording.facts() == {}


def test_a_signal_that_holds_lists_is_not_mistaken_for_numbers(recorder):
    recorder.array("topics/scan/ranges", [1.0, 2.0])
    recorder.scalar("topics/scan/range_min", 0.1)
    recorder.close()
    with pytest.raises(UsageError, match=r"topics/scan/ranges holds lists.*topics/scan/range_min"):
        Recording(recorder.path).signal("topics/scan/ranges")


@pytest.mark.parametrize("data", [b"", b"garbage", b"RRF2", b"RRF2" + bytes(range(256)) * 20, b"{}", b"\0" * 10_000])
def test_garbage_is_a_usage_error(tmp_path, data):
    path = tmp_path / "run.rrd"
    path.write_bytes(data)
    with pytest.raises(UsageError, match=r"run\.rrd is not a readable recording: \S+"):
        Recording(path)


def test_a_missing_file_and_a_folder_are_usage_errors(tmp_path):
    for path in (tmp_path / "none.rrd", tmp_path):
        with pytest.raises(UsageError, match="no recording at"):
            Recording(path)


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9, 0.99])
def test_a_truncated_file_is_read_as_far_as_it_goes_or_refused(recorder, share):
    for second in range(20):
        recorder.set_time(second * 1_000_000_000)
        recorder.scalar("a", second)
    recorder.close()
    data = recorder.path.read_bytes()
    recorder.path.write_bytes(data[: round(len(data) * share)])
    try:
        values = Recording(recorder.path).signal("a").values.tolist()
    except UsageError:
        return
    assert values == list(range(len(values)))
