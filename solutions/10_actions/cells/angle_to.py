from math import atan2, pi, remainder, tau


def angle_to(x, y, heading, goal_x, goal_y):
    return remainder(atan2(goal_y - y, goal_x - x) - heading, tau)
