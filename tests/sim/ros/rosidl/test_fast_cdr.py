"""Another Fast CDR than the expected one is refused with one sentence."""

import pytest

from gz_course.sim.ros.rosidl import fast_cdr


def test_the_installed_library_is_the_expected_one():
    assert {fast_cdr._places.buffer, fast_cdr._places.start, fast_cdr._places.size} == {112, 8, 16}


def test_a_missing_library_is_named(monkeypatch):
    monkeypatch.setattr(fast_cdr, "_LIBRARY", "libfastcdr.so.99")
    with pytest.raises(fast_cdr.LayoutError, match=r"need Fast CDR 2\.2 .* but libfastcdr\.so\.99: cannot open"):
        fast_cdr._library()


def test_a_missing_function_is_named(monkeypatch):
    monkeypatch.setattr(fast_cdr, "_POSITION", "position_of_another_version")
    with pytest.raises(fast_cdr.LayoutError, match="undefined symbol: position_of_another_version"):
        fast_cdr._library()


def test_another_layout_is_noticed(monkeypatch):
    import ctypes

    memory = ctypes.create_string_buffer(64)
    with pytest.raises(fast_cdr.LayoutError, match="the number of bytes was found at 0 places instead of one"):
        fast_cdr._Measured._place(memory, 4808, "the number of bytes")
