from math import floor


def index_of(x, y, info):
    origin = info.origin.position
    column = floor((x - origin.x) / info.resolution)
    row = floor((y - origin.y) / info.resolution)
    return row * info.width + column
