def valid_ranges(scan):
    return [r for r in scan.ranges if scan.range_min < r < scan.range_max]
