"""What is written in the headers of points in place of the scan's stamp and of the frame odom."""

from __future__ import annotations

import numpy as np

from gz_course.grader.record.reading import Signal

SHARE = 0.9  # of the points
SAME = 5e-4  # [s] between equal stamps


def stamps(given: Signal, other: np.ndarray, sent: np.ndarray, heard: np.ndarray) -> str:
    """Explain stamps that are `other` than those of the scans, `sent`; `heard` are the times of transforms [s]."""
    times, wrong = given.times[other] / 1e9, given.values[other]
    latest = heard[np.maximum(np.searchsorted(heard, times + SAME) - 1, 0)] if len(heard) else times + 1
    if np.mean(wrong == 0) >= SHARE:
        return "the stamps of your points are 0: nothing has set them"
    if np.mean(np.abs(wrong - np.floor(wrong)) < SAME) >= SHARE:
        return "the stamps of your points are whole seconds: a stamp is sec and nanosec"
    of_scans = np.mean(np.min(np.abs(wrong[:, None] - sent[None, :]), axis=1) <= SAME) >= SHARE
    if np.mean(np.abs(wrong - times) <= SAME) >= SHARE and of_scans:
        return (
            "the stamps of your points are those of the scan that has just come, in place of the one that waited, or "
            "they say when they were published, not when the scan was taken"
        )
    if np.mean(np.abs(wrong - times) <= SAME) >= SHARE:
        return "the stamps of your points say when they were published, not when the scan was taken"
    if of_scans:
        return "the stamps of your points are those of the next scan"
    if np.mean(np.abs(wrong - latest) <= SAME) >= SHARE:
        return "the stamps of your points are those of the latest transform, not of the scan"
    return ""


def frame(said: str) -> str:
    """Explain the frame_id of points; empty if it is the right one."""
    meant = {
        "": "empty",
        "robot": "the frame of the robot",
        "robot/scanner": "the frame in which the point was measured",
        "odom": "",
    }.get(said, "the frame in which the point was measured" if "scanner" in said else "no frame that exists here")
    return f"the frame_id of your points is {meant}, not that of their coordinates" if meant else ""
