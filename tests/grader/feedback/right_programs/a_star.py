"""A search with a heap and a heuristic, in functions only."""

import heapq
import itertools


def neighbours(cell):
    for dx, dy in itertools.product((-1, 0, 1), repeat=2):
        if (dx, dy) != (0, 0):
            yield (cell[0] + dx, cell[1] + dy), (dx * dx + dy * dy) ** 0.5


def search(start, goal, is_free):
    def guess(cell):
        return ((cell[0] - goal[0]) ** 2 + (cell[1] - goal[1]) ** 2) ** 0.5

    heap = [(guess(start), 0.0, start)]
    costs, parents = {start: 0.0}, {start: None}
    while heap:
        _, cost, cell = heapq.heappop(heap)
        if cell == goal:
            break
        if cost > costs[cell]:
            continue
        for near, step in neighbours(cell):
            new = cost + step
            if is_free(near) and new < costs.get(near, float("inf")):
                costs[near], parents[near] = new, cell
                heapq.heappush(heap, (new + guess(near), new, near))
    if goal not in parents:
        return None
    way = [goal]
    while parents[way[-1]] is not None:
        way.append(parents[way[-1]])
    way.reverse()
    return way
