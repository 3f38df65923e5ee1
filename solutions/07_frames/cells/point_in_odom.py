def point_in_odom(scan, transform, x, y):
    point = PointStamped(header=scan.header)
    point.point.x, point.point.y = x, y
    return do_transform_point(point, transform)
