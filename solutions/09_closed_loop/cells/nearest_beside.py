def nearest_beside(scan, side):
    sign = 1.0 if side == "left" else -1.0
    rays = []
    for i, distance in enumerate(scan.ranges):
        bearing = sign * (scan.angle_min + i * scan.angle_increment)
        if 0 <= bearing <= 0.8 * np.pi and scan.range_min < distance < scan.range_max:
            rays.append((distance, bearing))
    return min(rays)
