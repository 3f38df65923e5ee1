"""The registry of check kinds and the gate that no kind can do without."""

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec
from gz_course.grader.score.check import check_kind, check_kinds, perform, perform_all

SIGNAL = "truth/robot/x"


def spec(kind="change", **parameters):
    return CheckSpec(id="it", title="It", points=10, kind=kind, hints=("Do it.",), parameters=parameters)


GATE = {"signal": "truth/robot/distance", "reaches": 0.5, "otherwise": "it never drove"}


def test_an_unknown_kind_is_answered_with_the_nearest(record):
    with pytest.raises(ManifestError, match=r"'it'.*'chnage'.*did you mean 'change'\?"):
        perform(spec("chnage"), record())


def test_a_kind_cannot_be_registered_twice():
    assert "change" in check_kinds()
    with pytest.raises(ValueError, match="'change' is registered twice"):
        check_kind("change")(lambda recording, parameters: None)


@pytest.mark.parametrize(
    ("kind", "given", "missing"),
    [
        ("change", {"signal": SIGNAL}, "band"),
        ("change", {"band": [0, 1]}, "signal"),
        ("time_in_band", {"seconds": [1]}, "conditions"),
        ("time_in_band", {"conditions": [{"low": 1}], "seconds": [1]}, "signal"),
        ("stays_in_band", {"conditions": [{"signal": SIGNAL}]}, "last"),
        ("per_scan", {"scan": "lidar/scan", "tolerance": 0.1}, "statistic"),
        ("per_scan", {"scan": "lidar/scan", "statistic": "minimum", "tolerance": 0.1}, "log"),
    ],
)
def test_a_missing_parameter_is_named_with_its_check(record, kind, given, missing):
    with pytest.raises(ManifestError, match=rf"check 'it'.* lacks the parameter '{missing}'"):
        perform(spec(kind, **given), record({SIGNAL: [(0, 0.0)]}))


@pytest.mark.parametrize(
    ("kind", "given", "word"),
    [
        ("change", {"signal": SIGNAL, "band": 3}, "band"),
        ("change", {"signal": SIGNAL, "band": [1, 2, 3]}, "band"),
        ("time_in_band", {"conditions": [{"signal": SIGNAL, "low": "x"}], "seconds": [1]}, "low"),
        ("stays_in_band", {"conditions": [{"signal": SIGNAL}], "last": "long"}, "last"),
        ("per_scan", {"scan": "s", "statistic": "median", "tolerance": 0.1, "log": "(x)"}, "median"),
        ("per_scan", {"scan": "s", "statistic": "minimum", "tolerance": 0.1, "log": "("}, "log"),
        ("per_scan", {"scan": "s", "statistic": "minimum", "tolerance": 0.1, "log": "x"}, "log"),
        ("change", {"signal": SIGNAL, "band": [0, 1], "unti": "m"}, "unti"),
    ],
)
def test_a_wrong_parameter_is_a_manifest_error_that_names_it(record, kind, given, word):
    recording = record(
        {SIGNAL: [(0, 0.0), (8, 1.0)], "topics/s/range_min": [(0, 0.1)], "topics/s/range_max": [(0, 9.0)]},
        arrays={"topics/s/ranges": [(0, [1.0, 2.0])]},
        lines=[(0.1, "[INFO] [n]: x")],
    )
    with pytest.raises(ManifestError, match=rf"'it'.*{word}"):
        perform(spec(kind, **given), recording)


def test_the_gate_gives_points_only_for_its_evidence(record):
    def found(distance):
        recording = record({SIGNAL: [(0, 0.0), (8, 0.0)], "truth/robot/distance": distance})
        return perform(spec(signal=SIGNAL, band=[-1, 1], gate=GATE), recording)

    assert found([(0, 0.0), (5, 0.5)]).passed, "the bound itself is enough"
    assert found([(0, 0.9), (5, 0.1)]).passed, "reached once is reached"
    for too_little in ([(0, 0.0), (5, 0.499)], []):
        finding = found(too_little)
        assert not finding.passed
        assert finding.measured.startswith("it never drove")


def test_a_failure_behind_a_closed_gate_is_told_as_such(record):
    """What never drove has not turned the wrong way either; it is marked, so that it is not blamed first."""
    shut = perform(spec(signal=SIGNAL, band=[-1, 1], gate=GATE), record({SIGNAL: [(0, 0.0), (8, 5.0)]}))
    assert (shut.passed, shut.measured, shut.gated) == (False, "it never drove", True)
    drove = {SIGNAL: [(0, 0.0), (8, 5.0)], "truth/robot/distance": [(0, 9.0)]}
    finding = perform(spec(signal=SIGNAL, band=[-1, 1], gate=GATE), record(drove))
    assert (finding.passed, finding.measured, finding.gated) == (False, "changed by 5.00", False)


def test_a_gate_that_lacks_a_key_is_a_manifest_error(record):
    with pytest.raises(ManifestError, match="'it': gate lacks the parameter 'reaches'"):
        perform(spec(signal=SIGNAL, band=[-1, 1], gate={"signal": SIGNAL}), record({SIGNAL: [(0, 0.0)]}))


def test_every_one_of_several_gates_must_be_open(record):
    back = {"signal": "truth/robot/x", "falls_to": -1.0, "otherwise": "it never drove back"}
    for rows, told in (
        ([0.9, -1.0], ""),
        ([0.9, -0.9], "it never drove back"),
        ([0.1, -1.0], "it never drove"),
        ([0.1, 0.0], "it never drove"),
    ):
        signals = {
            SIGNAL: [(0, 0.0), (8, 0.0)],
            "truth/robot/distance": [(0, rows[0])],
            "truth/robot/x": [(0, 0.0), (1, rows[1]), (2, 0.0)],
        }
        finding = perform(spec(signal=SIGNAL, band=[-1, 1], gate=[GATE, back]), record(signals))
        assert (finding.passed, finding.gated) == (not told, bool(told))
        assert not told or finding.measured == told


def chained(*gates):
    """Checks a, b, ...; each passes by itself if its band begins below 1, and is gated by the check named."""
    return [
        CheckSpec(
            id,
            "A title",
            10,
            "change",
            "A hint.",
            {"signal": SIGNAL, "band": band} | ({"gate": {"check": gate, "otherwise": f"not {gate}"}} if gate else {}),
        )
        for id, band, gate in gates
    ]


def test_quality_counts_only_after_success(record):
    recording = record({SIGNAL: [(0, 0.0), (8, 1.0)]})
    good, bad = [0, 2], [5, 6]
    found = perform_all(chained(("a", good, "b"), ("b", good, "c"), ("c", good, "")), recording)
    assert [finding.passed for finding in found] == [True, True, True]
    found = perform_all(chained(("a", good, "b"), ("b", good, "c"), ("c", bad, "")), recording)
    assert [finding.passed for finding in found] == [False, False, False]
    assert [(f.measured, f.gated) for f in found] == [("not b", True), ("not c", True), ("changed by 1.00", False)]


def test_gates_that_wait_for_each_other_or_for_nothing(record):
    recording = record({SIGNAL: [(0, 0.0), (8, 1.0)]})
    with pytest.raises(ManifestError, match="the gates of the checks a, b wait for each other"):
        perform_all(chained(("a", [0, 2], "b"), ("b", [0, 2], "a")), recording)
    with pytest.raises(ManifestError, match=r"check 'alpha': its gate names no check: 'alph'; did you mean 'alpha'"):
        perform_all(chained(("alpha", [0, 2], "alph")), recording)


def test_every_kind_says_how_it_is_written(root):
    """The file of a kind is its manual: it begins with the kind's name and holds an example of it."""
    for name in check_kinds():
        text = (root / "grader/score/checks" / f"{name}.py").read_text()
        assert f"`{name}`: " in text.splitlines()[0], name
        assert f'kind = "{name}"' in text, name
