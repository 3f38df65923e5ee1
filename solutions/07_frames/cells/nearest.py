from math import cos, sin


def nearest(scan):
    hits = [(r, i) for i, r in enumerate(scan.ranges) if scan.range_min < r < scan.range_max]
    distance, ray = min(hits)
    angle = scan.angle_min + ray * scan.angle_increment
    return distance * cos(angle), distance * sin(angle)
