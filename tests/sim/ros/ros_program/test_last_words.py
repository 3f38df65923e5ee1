"""Why a program ended at its start can be read later, until it is started again."""

import time

from gz_course.sim.ros.ros_program.last_words import LastWords, forget, found, leave


def test_what_is_left_is_found_until_it_is_forgotten(tmp_path):
    folder = tmp_path / "log"
    now = int(time.time()) - 10.0
    old = LastWords("parameter_bridge", 11, now - 7200, 7, "ours", ("long ago",))
    first = LastWords("parameter_bridge", 12, now, 7, "a:b c", ("bridge.yaml:3: two\nlines", "another"))
    other = LastWords("image_bridge", 13, now + 1, 0, "", ("no topic",))
    assert found(folder) == []
    for words in (other, first, old):
        leave(folder, words)
    (folder / f"python3_14_{int(now * 1000)}.log").write_text("[FATAL] [1.5] [node]: of another kind\n")
    (folder / f"python3_15_{int(now * 1000)}.log").write_bytes(b"\xff\0")
    assert [(words.pid, words.sentences) for words in found(folder)] == [
        (12, ("bridge.yaml:3: two lines", "another")),
        (13, ("no topic",)),
    ]
    assert found(folder)[1] == other
    forget(folder, first.place)
    assert [words.pid for words in found(folder)] == [13]
    leave(folder / other.file_name / "a file is no folder", other)
