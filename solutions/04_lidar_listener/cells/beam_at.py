def beam_at(scan, angle):
    return round((angle - scan.angle_min) / scan.angle_increment)
