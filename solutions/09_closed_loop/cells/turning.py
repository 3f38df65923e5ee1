def turning(distance, bearing, wanted):
    away = bearing - np.pi / 2
    towards = max(-0.7, min(0.7, 2.0 * (distance - wanted)))
    return max(-1.5, min(1.5, 2.0 * (away + towards)))
