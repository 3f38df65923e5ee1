"""Columns of recordings as plain values."""

import pyarrow as pa
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.record.reading import flattened

NUMBERS = st.lists(st.floats(allow_nan=False), max_size=3)
SLICES = st.tuples(st.integers(0, 4), st.integers(0, 6))


@given(st.lists(NUMBERS | st.none(), max_size=6), SLICES)
def test_lists_are_flattened_as_arrow_does(rows, part):
    column = pa.array(rows, pa.list_(pa.float64())).slice(*part)
    assert flattened(column).to_pylist() == column.flatten().to_pylist()


@given(st.lists(st.lists(st.integers(0, 9), min_size=3, max_size=3), max_size=6), SLICES)
def test_lists_of_one_length_are_flattened_as_arrow_does(rows, part):
    column = pa.array(rows, pa.list_(pa.int64(), 3)).slice(*part)
    assert flattened(column).to_pylist() == column.flatten().to_pylist()
