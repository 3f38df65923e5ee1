from math import cos, sin


def point_of(scan, i):
    angle = scan.angle_min + i * scan.angle_increment
    return scan.ranges[i] * cos(angle), scan.ranges[i] * sin(angle)
