from math import cos, floor, sin


def passed_cells(x, y, angle, distance):
    cells = set()

    def cell(way):
        there = x + way * cos(angle), y + way * sin(angle)
        return floor((there[1] - BOTTOM) / SIZE), floor((there[0] - LEFT) / SIZE)

    for step in range(int(distance / SIZE * 2) + 1):
        cells.add(cell(step * SIZE / 2))
    cells.discard(cell(distance))
    return cells
