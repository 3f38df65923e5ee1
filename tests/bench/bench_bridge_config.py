"""Ten thousand configurations of a bridge that nobody would write: each gets its findings, none a traceback."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_bridge.arguments import read_arguments
from gz_course.sim.bridge.ros_gz_bridge.config import MAX_BYTES, read_file, read_yaml
from gz_course.sim.bridge.ros_gz_bridge.entry_reader import KEYS, SERVICE_KEYS
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import pairs
from gz_course.tests.bench.row import Row

FILES, ARGUMENTS = 7000, 3000
PAIRS = pairs()
scalars = st.one_of(
    st.sampled_from([pair.ros_type for pair in PAIRS] + [pair.gz_type for pair in PAIRS]),
    st.sampled_from(
        ["/a", "~/a", "a//b", "GZ_TO_ROS", "gz_to_ros", "true", "maybe", "0", "-3", "1e400", "~", "!!binary x"]
    ),
    st.sampled_from(["[*a]", "&a [*a]", "*a", "{a: {b: c}}", "!!python/object/apply:os.system [x]", "2020-13-99", "'"]),
    st.text(max_size=20),
)
keys = st.one_of(st.sampled_from([*KEYS, *SERVICE_KEYS]), st.text("abdeginopryst_", max_size=12), st.just("? [x]"))
entries = st.lists(st.tuples(keys, scalars), max_size=6).map(
    lambda pairs: "- " + "  ".join(f"{key}: {value}\n" for key, value in pairs)
)
texts = st.one_of(
    st.lists(entries, max_size=4).map("".join),
    st.text(max_size=200),
    st.binary(max_size=200),
    st.text("-[]{}:,&*!|>'\"%@` \n\tab0", max_size=100),
)
arguments = st.one_of(
    st.text("@[]/ab_.~ \n", max_size=40),
    st.tuples(st.text(max_size=8), scalars, st.sampled_from("@[] "), scalars).map(
        lambda parts: "{}@{}{}{}".format(*parts)
    ),
)


def _run(strategy, examples, body):
    """How many examples were tried, and how many were answered wrongly; an exception ends it."""
    counts = [0, 0]

    @settings(
        max_examples=examples,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(strategy)
    def each(example):
        counts[0] += 1
        counts[1] += not body(example)

    each()
    return counts


def _file(text):
    findings = read_yaml(text, "b.yaml").findings
    return all(each.place.removeprefix("b.yaml:").isdigit() and "\n" not in str(each) for each in findings)


def _argument(text):
    findings = read_arguments([text]).findings
    return all(str(each).startswith("argument '") and "\n" not in str(each) for each in findings)


def rows() -> Iterator[Row]:
    started = time.monotonic()
    for what, strategy, examples, body in (
        ("files", texts, FILES, _file),
        ("arguments", arguments, ARGUMENTS, _argument),
    ):
        tried, wrong = _run(strategy, examples, body)
        took = (time.monotonic() - started) / max(tried, 1) * 1e3
        measured = f"{wrong} of {tried} without place or with a traceback"
        yield Row(f"bridge configuration, generated {what}", measured, f"{took:.1f} ms each", "-", "0")
        started = time.monotonic()
    yield from _hostile()


def _hostile():
    bomb = "- &a {topic_name: x}\n" + "".join(
        f"- &{new} [{','.join(['*' + old] * 9)}]\n" for old, new in zip("abcdefghi", "bcdefghij", strict=True)
    )
    deep = "[" * 100_000
    long_key = "- " + "k" * 200_000 + ": 1\n"
    many = "- {topic_name: /a, ros_type_name: nope/msg/X, gz_type_name: gz.msgs.Y}\n" * 3000
    with tempfile.TemporaryDirectory() as folder:
        huge = Path(folder, "huge.yaml")
        with huge.open("wb") as file:
            file.truncate(100_000_000)
        for name, read in (
            ("alias bomb", lambda: read_yaml(bomb, "b.yaml")),
            ("100,000 levels deep", lambda: read_yaml(deep, "b.yaml")),
            ("key of 200 kB", lambda: read_yaml(long_key, "b.yaml")),
            ("3000 wrong bridges", lambda: read_yaml(many[: MAX_BYTES - 1], "b.yaml")),
            ("100 MB", lambda: read_file(huge)),
        ):
            started = time.monotonic()
            found = read().findings
            took = time.monotonic() - started
            yield Row(
                f"bridge configuration, {name}", f"{took * 1e3:.0f} ms", f"{len(found)} findings", "-", "at most 1 s"
            )
