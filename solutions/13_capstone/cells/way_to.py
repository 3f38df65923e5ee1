from collections import deque


def way_to(open_cells, goals, start):
    before, queue = {start: None}, deque([start])
    while queue:
        cell = queue.popleft()
        if goals[cell]:
            way = []
            while cell is not None:
                way.insert(0, cell)
                cell = before[cell]
            return way
        row, column = cell
        for beside in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if open_cells[beside] and beside not in before:
                before[beside] = cell
                queue.append(beside)
    return []
