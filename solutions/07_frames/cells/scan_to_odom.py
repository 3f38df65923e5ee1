def scan_to_odom(buffer, scan):
    when = Time.from_msg(scan.header.stamp)
    return buffer.lookup_transform("odom", scan.header.frame_id, when)
