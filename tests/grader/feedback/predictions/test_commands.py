"""Wrong drives, one misconception each, by a timer whose clock comes seldom; the first sentence names the fault."""

import dataclasses
import math

import numpy as np
import pytest

from gz_course.grader.feedback.predictions.commands import Drive, explain

END, TICK = 8.0, 0.25


def drive(program, period=0.1, tick=TICK):
    """Return what arrives of a program, called with the time [s] and the number of the call, that may return None."""
    due, calls, rows = period, 0, []
    for step in range(1, round(END / tick) + 1):
        now = step * tick
        if now + 1e-9 < due:
            continue
        due += period * math.ceil((now - due) / period + 1e-6)  # a timer misses ticks
        sent = program(now, calls)
        calls += 1
        for each in sent if isinstance(sent, list) else [sent] if sent else []:
            rows.append((now, *each))
    table = np.array(rows, dtype=float).reshape(-1, 3)
    linear, angular = np.zeros((len(table), 3)), np.zeros((len(table), 3))
    linear[:, 0], angular[:, 2] = table[:, 1], table[:, 2]
    return Drive(table[:, 0], linear, angular, END, 0.5, 5.0)


GO, STOP = (0.5, 0.1), (0.0, 0.0)


def right(now, calls):
    return GO if now - TICK < 5.0 else STOP


def scaled(linear, angular):
    return lambda now, calls: (linear * right(now, calls)[0], angular * right(now, calls)[1])


WRONG = {
    "linear.x stays at 0.50 m/s: both must be 0": drive(lambda now, calls: GO if now < 5.2 else (0.5, 0.0)),
    "50 commands came at the same moment": drive(lambda now, calls: [GO] * 50 if calls == 0 else None),
    "first turns and then drives": drive(
        lambda now, calls: (0.0, 0.1) if now < 2.7 else (0.5, 0.0) if now < 5.2 else STOP
    ),
    "it drives the robot backwards; 0 stops it": drive(lambda now, calls: GO if now < 5.2 else (-0.5, 0.0)),
    "the sign of angular.z changes from command": drive(lambda now, calls: (0.5, 0.1 * (-1) ** calls)),
    "angular.z changes from command to command, between 0.00 and": drive(
        lambda now, calls: (0.5, 0.7 * math.sin(0.6 * (now - TICK))) if now < 5.2 else STOP
    ),
    "no slight turn": drive(scaled(1, 6)),
    "the speed in km/h": drive(scaled(3.6, 1)),
    "the speed in cm/s": drive(scaled(100, 1)),
    "half the speed": drive(scaled(0.5, 1)),
    "twice the speed": drive(scaled(2, 1)),
    "drives backwards": drive(scaled(-1, 1)),
    "turns to the right": drive(scaled(1, -1)),
    "degrees per second": drive(scaled(1, 57.3)),
    "the robot drives straight": drive(scaled(1, 0)),
    "are swapped": drive(lambda now, calls: right(now, calls)[::-1]),
    "all 32 commands were zero": drive(lambda now, calls: STOP),
    "0.40 m/s where": drive(scaled(0.8, 1)),
    "too weak for a turn": drive(scaled(1, 0.1)),
    "your node counts ticks": drive(lambda now, calls: GO if calls < 25 else STOP, period=0.2),
    "ticks of the timer were counted as seconds": drive(lambda now, calls: GO if calls < 5 else STOP, period=0.5),
    "and not one stops it": drive(lambda now, calls: GO),
    "your node falls silent": drive(lambda now, calls: GO if now < 5.2 else None),
    "one command only arrived": drive(lambda now, calls: GO if calls == 0 else None),
    "whole seconds": drive(lambda now, calls: GO if int(now) - int(TICK) <= 5 else STOP),
    "microseconds": drive(lambda now, calls: GO if (now - TICK) * 1000 < 5.0 else STOP),
    "half of what is asked for": drive(lambda now, calls: GO if now - TICK < 2.5 else STOP),
    "where 5 s are asked for": drive(lambda now, calls: GO if now - TICK < 3.5 else STOP),
    "the wrong way round": drive(lambda now, calls: STOP if now - TICK < 5.0 else GO),
    "a timer fires first after its period": drive(lambda now, calls: None if now - TICK < 5.0 else GO),
    "first driven at 2.25 s": drive(lambda now, calls: right(now - 2.0, calls) if now > 2.1 else None),
    "alternates between 0.00 and 0.50": drive(lambda now, calls: GO if calls % 2 else STOP),
    "two publish() calls": drive(lambda now, calls: [GO, STOP] if now < 5.2 else STOP),
    "driven again at": drive(lambda now, calls: GO if now % 4 < 2.6 else STOP),
    "a ramp": drive(lambda now, calls: (min(0.5, 0.02 * calls), 0.1) if now < 5.2 else STOP),
    "until 2.00 s and falls again from 4.00 s on, ramps at both ends": drive(
        lambda now, calls: (min(0.5, 0.25 * now, 0.5 * (5.2 - now)), 0.1) if now < 5.2 else STOP
    ),
    "slower and no stop": drive(lambda now, calls: GO if now < 5.2 else (0.1, 0.0)),
    "what sends the drive goes on after the stop": drive(lambda now, calls: STOP if now == 5.0 else GO),
    "each Twist takes the place of the one before": drive(
        lambda now, calls: [(0.5, 0.0), (0.0, 0.1)] if now < 5.2 else STOP
    ),
    "0.50 m/s at first and 0.25 m/s from 2.75 s on": drive(
        lambda now, calls: GO if now < 2.6 else (0.25, 0.1) if now < 5.2 else STOP
    ),
    "angular.z goes from 0.00 to 1.90 rad/s": drive(lambda now, calls: (0.5, 0.1 * calls) if now < 5.2 else STOP),
    "angular.z is 0 from 2.75 s on, while the robot still drives": drive(
        lambda now, calls: (GO if now < 2.6 else (0.5, 0.0)) if now < 5.2 else STOP
    ),
    "angular.z is 0 until 2.75 s, while": drive(
        lambda now, calls: ((0.5, 0.0) if now < 2.6 else GO) if now < 5.2 else STOP
    ),
    "pi/4, 45 degrees in every second": drive(scaled(1, 7.854)),
    "57 degrees in every second": drive(scaled(1, 10)),
    "the value was in rad/s already": drive(scaled(1, math.radians(1))),
    "as if it were multiplied by the five seconds": drive(scaled(5, 1)),
    "the stop waits for the first one after 5 s": drive(lambda now, calls: GO if now - 2.0 < 5.0 else STOP, period=2.0),
    "the sign of angular.z changes once": drive(
        lambda now, calls: (0.5, 0.1 if now < 2.6 else -0.1) if now < 5.2 else STOP
    ),
    "angular.z stays at 0.10": drive(lambda now, calls: GO if now < 5.2 else (0.0, 0.1)),
}


def test_every_misconception_is_named():
    said = {words: explain(each) for words, each in WRONG.items()}
    assert {words: sentence for words, sentence in said.items() if words not in sentence} == {}


def test_the_wrong_field_is_named():
    sideways = drive(right)
    sideways.angular[:, 0], sideways.angular[:, 2] = sideways.angular[:, 2], 0.0
    assert "angular.x was set to 0.10, but the robot takes its command from angular.z" in explain(sideways)


def test_a_speed_along_the_axes_of_the_world_is_no_ramp():
    world = drive(right)
    heading = 0.2 * world.times[world.moving]
    world.linear[world.moving, 0], world.linear[world.moving, 1] = 0.5 * np.cos(heading), 0.5 * np.sin(heading)
    assert "in the robot's own frame" in explain(world) and "ramp" not in explain(world)


def test_a_speed_sideways_is_no_turn():
    sideways = drive(scaled(1, 0))
    sideways.linear[:, 1] = 0.2 * (sideways.linear[:, 0] > 0)
    assert "linear.y is a speed sideways" in explain(sideways)


def test_a_drive_that_is_too_long_is_not_taken_for_counted_ticks():
    six = explain(drive(lambda now, calls: GO if now - TICK < 6.0 else STOP))
    assert ("counts ticks" not in six and "driven for" in six) or "whole seconds" in six


@pytest.mark.parametrize(("period", "tick"), [(0.1, 0.25), (0.1, 0.01), (0.05, 0.01), (0.5, 0.25)])
def test_a_right_drive_has_no_explanation(period, tick):
    assert explain(drive(lambda now, calls: GO if now - period < 5.0 else STOP, period, tick)) == ""


def test_two_that_fit_are_both_named():
    both = explain(drive(lambda now, calls: (-0.5, -0.1) if now < 5.2 else STOP))
    assert "drives backwards" in both and "turns to the right" in both


def suspected(about, words, program, period=0.1):
    """Return the explanation of a drive whose file holds one suspect."""
    return explain(dataclasses.replace(drive(program, period), suspects={about: words}))


def test_a_suspect_is_named_once_its_symptom_is_seen():
    assert suspected("endless", "line 7: x", lambda now, calls: GO).endswith("not one stops it: line 7: x")
    holds = suspected("decides", "line 7, `if a < 5:`", lambda now, calls: GO)
    assert "not one stops it: line 7, `if a < 5:` decides that, and it never changes; what your node compares" in holds
    assert "line 7" not in suspected("endless", "line 7: x", right)
    again = suspected("again", "line 9: y", lambda now, calls: STOP if now == 5.25 else GO)
    assert again.endswith("at 5.50 s the robot is driven again: line 9: y")
    place = suspected("by_place", "line 3: z", lambda now, calls: GO if now < 1.75 else STOP)
    assert place == "the robot was driven for 1.50 s, where 5 s are asked for: line 3: z"


def test_commands_that_come_in_bundles_are_no_loop():
    bundles = drive(lambda now, calls: [GO if now < 2.0 else STOP] * 12, period=0.25)
    assert "at the same moment" not in explain(bundles)
