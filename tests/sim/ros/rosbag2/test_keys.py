"""Keys of the terminal do something, and are told apart."""

import os
import threading

from gz_course.sim.ros.rosbag2 import keys


def test_keys_call_what_they_stand_for_until_the_end():
    assert list(keys.pressed_keys(" \x1b[Ax\x1b[C\x1b")) == [" ", keys.UP, "x", keys.RIGHT, "\x1b"]
    window, terminal = os.openpty()
    closed, closing = os.pipe()
    pressed, done = [], threading.Event()
    actions = {keys.SPACE: lambda: pressed.append("space"), keys.DOWN: lambda: (pressed.append("down"), done.set())}
    listener = threading.Thread(target=keys._listen, args=(terminal, closed, actions))
    listener.start()
    os.write(window, b" q\x1b[B\n")
    assert done.wait(60)
    os.close(closing)
    listener.join(60)
    assert (listener.is_alive(), pressed) == (False, ["space", "down"])
    for each in (window, terminal, closed):
        os.close(each)


def test_without_a_terminal_there_are_no_keys(monkeypatch, tmp_path):
    with (tmp_path / "input").open("w+") as file:
        monkeypatch.setattr("sys.stdin", file)
        with keys.keys({}) as heard:
            assert heard is False
