"""Boxes never overlap, and every arrow begins and ends at its boxes."""

from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.show.rqt_graph.layered_layout import ROW_GAP, layout

NAMES = st.sampled_from("abcdefghij")
GRAPHS = st.tuples(
    st.dictionaries(NAMES, st.tuples(st.floats(10, 300), st.floats(10, 60)), min_size=1),
    st.sets(st.tuples(NAMES, NAMES), max_size=20),
)


@settings(max_examples=30, deadline=None)
@given(GRAPHS)
def test_boxes_are_apart_and_arrows_join_them(graph):
    sizes, arrows = graph
    arrows = {arrow for arrow in arrows if set(arrow) <= sizes.keys()}
    placed = layout(sizes, arrows)
    boxes = {key: (*placed.places[key], *sizes[key]) for key in sizes}
    for key, (x, y, width, height) in boxes.items():
        assert min(x, y) >= -1e-6
        assert x + width <= placed.width + 1e-6
        assert y + height <= placed.height + 1e-6
        for other, (x_2, y_2, width_2, height_2) in boxes.items():
            beside = x + width <= x_2 or x_2 + width_2 <= x
            gap = max(y_2 - y - height, y - y_2 - height_2)
            assert key == other or beside or gap >= ROW_GAP - 1e-6
    assert placed.ways.keys() == {(start, end) for start, end in arrows if start != end}
    for (start, end), way in placed.ways.items():
        for (x, y), key in ((way[0], start), (way[-1], end)):
            left, top, width, height = boxes[key]
            assert x in (left, left + width)
            assert abs(y - top - height / 2) < 1e-6


def test_a_chain_leads_to_the_right():
    placed = layout(dict.fromkeys("abc", (50.0, 20.0)), [("b", "c"), ("a", "b")])
    assert placed.places["a"][0] < placed.places["b"][0] < placed.places["c"][0]
    assert len({y for _, y in placed.places.values()}) == 1


def test_nothing_is_laid_out():
    placed = layout({}, [])
    assert (placed.places, placed.width, placed.height) == ({}, 0.0, 0.0)
