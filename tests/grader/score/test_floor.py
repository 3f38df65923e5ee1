"""A floor from above: distances to boxes and cylinders, cells of points, and what rays have passed."""

from math import pi

import numpy as np
import pytest

from gz_course.grader.score.floor import Grid, Scans, Shapes, grown, hits, misplaced

WIDTH, HEIGHT = 100, 80
GRID = Grid(0.1, WIDTH, HEIGHT, -5.0, -4.0)
cells, middles, along = GRID.cells, GRID.middles, GRID.along

TURNED = Shapes([("crate", (1.0, 0.0, pi / 2), np.array([0.5, 0.1]))], [("pillar", (-2.0, 1.0, 0.0), 0.25)])


def one_ray(distance, heading=0.0):
    """A scan of a single ray straight ahead, from (0.05, 0.05)."""
    ranges = np.array([[distance]])
    return Scans(np.array([[0.05, 0.05, heading]]), ranges, np.zeros(1), np.isfinite(ranges), 3.0)


def test_distances_to_a_turned_box_and_a_cylinder():
    points = np.array([[1.0, 0.8], [1.3, 0.0], [1.0, 0.4], [-2.0, 2.0]])
    distances, names = TURNED.distances(points)
    assert names == ["crate", "pillar"]
    assert distances[0][:3] == pytest.approx([0.3, 0.2, 0.0])
    assert distances[1][3] == pytest.approx(0.75)
    assert TURNED.nearest(points)[3] == pytest.approx(0.75)


def test_the_middle_of_each_cell_lies_in_it():
    assert (cells(middles()) == 1).all()
    assert cells(np.array([[-5.01, 0.0], [5.01, 0.0], [0.0, 4.01]])).sum() == 0


def test_rows_go_with_y_and_columns_with_x():
    (row,), (column,) = np.nonzero(cells(np.array([[-4.95, 3.95]])))
    assert (row, column) == (HEIGHT - 1, 0)


def test_a_ray_passes_cells_and_ends_in_one():
    scan = one_ray(1.0)
    assert np.argwhere(cells(hits(scan))).tolist() == [[40, 60]]
    passed = np.argwhere(along(scan, 0, scan.ends - 0.2, scan.hit))
    assert passed.tolist() == [[40, column] for column in range(50, 58)]


def test_a_ray_without_a_hit_ends_at_the_farthest():
    scan = one_ray(np.inf)
    assert not len(hits(scan))
    assert hits(scan, which=~scan.hit) == pytest.approx(np.array([[3.05, 0.05]]))


def test_a_heading_that_is_ignored_is_one_of_the_mistakes():
    said = {words.partition(":")[0]: points for words, points in misplaced(one_ray(1.0, heading=pi / 2))}
    assert said["the robot's heading is ignored"] == pytest.approx(np.array([[1.05, 0.05]]))


def test_grows_by_one_cell_in_all_directions_but_not_around_the_edge():
    marked = np.zeros((HEIGHT, WIDTH), dtype=bool)
    marked[0, 0] = marked[10, 10] = True
    assert grown(marked).sum() == 4 + 9


def test_rays_that_are_numbered_after_some_were_left_out():
    scan = Scans(np.zeros((1, 3)), np.array([[np.inf, 1.0]]), np.array([0.0, pi / 2]), np.array([[False, True]]), 3.0)
    said = {words.partition(":")[0]: points for words, points in misplaced(scan)}
    numbered = said["rays without a hit are left out before the others are numbered"]
    assert numbered == pytest.approx(np.array([[1.0, 0.0]]))


def test_headings_that_are_made_in_a_wrong_way():
    poses = np.array([[0.05, 0.05, 0.0], [0.05, 0.05, pi / 2]])
    turned = Scans(poses, np.full((2, 1), 1.0), np.zeros(1), np.full((2, 1), True), 3.0)
    said = {words.partition(" ")[0]: points for words, points in misplaced(turned)}
    assert said["z"] == pytest.approx(np.array([[-0.95, 0.05], [0.05, 1.05]]))
    assert not any(words.startswith("z and w") for words, _ in misplaced(one_ray(1.0, heading=pi / 2)))
