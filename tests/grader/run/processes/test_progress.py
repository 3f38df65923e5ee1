"""What a process says about itself: read with suspicion."""

import json

from hypothesis import example, given, settings
from hypothesis import strategies as st

from gz_course.grader.run.processes.progress import Endpoint, Progress

GOOD = {"clock": 5, "idle": True, "taken": {"/a": 1}, "published": {"/b": 2}, "delivered": {"/b": 4}}
GOOD |= {"holding": False, "held": 0, "released": 0, "flushes": 0, "endpoints": []}
ENDPOINT = {"node": "/n", "kind": "publisher", "topic": "/t", "type": "x/msg/Y"} | {
    "reliability": "RELIABLE",
    "durability": "VOLATILE",
    "matched": 1,
}
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


def sound(progress):
    """Whether everything in a report has the type it is said to have, so that nothing behind it can stumble."""
    counts = [*progress.taken.items(), *progress.published.items(), *progress.delivered.items()]
    return (
        (progress.clock is None or type(progress.clock) is int)
        and all(type(each) is int for each in (progress.flushes, progress.held, progress.released))
        and type(progress.idle) is type(progress.holding) is bool
        and all(type(topic) is str and type(count) is int for topic, count in counts)
        and all(
            isinstance(e, Endpoint)
            and all(type(getattr(e, n)) is str for n in ("node", "kind", "topic", "type", "reliability", "durability"))
            and type(e.matched) is int
            for e in progress.endpoints
        )
    )


@settings(deadline=None)
@given(st.binary(max_size=200) | JSON.map(lambda value: json.dumps(value).encode()))
@example(b"[" * 100_000)
def test_a_report_that_is_none_is_nothing(data):
    progress = Progress.parse(data, None)
    assert progress is None or sound(progress)


@settings(deadline=None, max_examples=300)
@given(st.sampled_from([*GOOD, *(f"endpoint {key}" for key in ENDPOINT)]), JSON)
@example("clock", float("inf"))
@example("taken", {"/a": float("inf")})
@example("endpoint topic", ["/t"])
@example("endpoint kind", {})
@example("endpoint topic", None)
def test_a_lie_in_one_place_is_refused_or_harmless(key, value):
    report = dict(GOOD)
    if key.startswith("endpoint "):
        report["endpoints"] = [ENDPOINT | {key.split()[1]: value}]
    else:
        report[key] = value
    progress = Progress.parse(json.dumps(report).encode(), None)
    assert progress is None or sound(progress)


def test_endpoints_that_are_not_mentioned_are_as_before():
    before = Progress.parse(json.dumps(GOOD | {"endpoints": [ENDPOINT]}).encode(), None)
    assert before.endpoints == (Endpoint(**ENDPOINT),)
    rest = {key: value for key, value in GOOD.items() if key != "endpoints"}
    assert Progress.parse(json.dumps(rest).encode(), before).endpoints is before.endpoints
    assert Progress.parse(json.dumps(rest).encode(), None).endpoints == ()
