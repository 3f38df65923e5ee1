def hit_points(pose, scan):
    x, y, heading = pose
    ranges = np.array(scan.ranges)
    angles = heading + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    hit = (ranges > scan.range_min) & (ranges < scan.range_max)
    return x + ranges[hit] * np.cos(angles[hit]), y + ranges[hit] * np.sin(angles[hit])
