def ready(waiting, buffer):
    found = []
    for scan in list(waiting):
        when = Time.from_msg(scan.header.stamp)
        if buffer.can_transform("odom", scan.header.frame_id, when):
            waiting.remove(scan)
            found.append(scan)
    return found
