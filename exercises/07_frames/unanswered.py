"""Why scans got no point: what the node asked tf2 for, as its file says, compared with what there is."""

FRAMES = ("odom", "robot", "robot/scanner", "robot/base_link", "robot/lidar_link")  # of the bridge
FEW = 0.5  # of the scans


def shared_header(recording):
    """Return the end of a sentence on a frame_id that was changed for two messages; empty if none was."""
    for place in recording.facts().get("shared_headers", []):
        return (
            f"; line {place['line']} changes the frame_id of the other message, too: a = b copies no header, so both "
            "have the same one"
        )
    return ""


def reason(recording, infinite, given, scans):
    """Return the beginning of a sentence on why `given` of so many scans got a point; empty if it is not known.

    `infinite` coordinates were no finite numbers.
    """
    if given > FEW * scans:
        return ""
    if infinite:
        return (
            f"{infinite} coordinates of your points are inf or nan: a ray without a hit was taken, whose range is inf. "
            "Only ranges between range_min and range_max are hits"
        )
    lookups = recording.facts().get("lookups", [])
    for lookup in lookups:
        place = f"line {lookup['line']} asks for"
        for frame in lookup["frames"]:
            if frame.startswith("/"):
                return f"{place} the frame {frame!r}: names of frames do not begin with a slash in tf2"
            if frame not in FRAMES:
                return (
                    f"{place} the frame {frame!r}, which does not exist here: the transforms lead from odom to robot "
                    "and from there to the frame_id of the scan, as /tf and /tf_static say"
                )
    for lookup in lookups:
        if lookup["gives_up"]:
            return (
                f"line {lookup['line']} asks for the transform of the scan's time when the scan comes; the transform "
                "comes later, and the node gives the scan up. Keep the scan, and ask again when the next one comes"
            )
    return ""
