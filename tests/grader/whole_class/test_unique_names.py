"""Nobody's results land under another's name, on any file system; names with every trouble are unique and printable."""

import io
import itertools
import unicodedata
import zipfile
from contextlib import ExitStack

from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.whole_class.found import find_submissions
from gz_course.grader.whole_class.students_folder import LONGEST, folder_name
from gz_course.grader.whole_class.unique_names import folded, unique_names
from gz_course.tests.generated_class import FILE, TROUBLES, hand_in, names, texts

SHARP = "\N{LATIN SMALL LETTER SHARP S}"
NAMES = st.lists(st.text(alphabet="aAbBeé\u0301ßsS [1]2", max_size=6), max_size=12)
DEVICES = ("CON", "con.txt", "Aux.tar.gz", "nul", "COM1", "lpt9.py", "LPT²")


@given(NAMES, st.data())
def test_names_stay_different_when_they_are_folded(names, data):
    ids = data.draw(st.lists(st.sampled_from(["", "1", "2"]), min_size=len(names), max_size=len(names)))
    found = unique_names(names, ids)
    assert len({folded(name) for name in found}) == len(names)
    assert all(label.startswith(name) for label, name in zip(found, names, strict=True))
    folders = [folder_name(name) for name in found]
    assert len({folded(name) for name in folders}) == len(names)


def test_twins():
    composed, combining = (unicodedata.normalize(form, "Zoë") for form in ("NFC", "NFD"))
    assert folded(composed) == folded(combining) and folded("STRASSE") == folded(f"stra{SHARP}e")
    assert unique_names([composed, combining, "jane", "Jane"], [""] * 4) == [
        composed,
        f"{combining} [1]",
        "jane",
        "Jane [1]",
    ]
    assert unique_names(["Jo", "Jo", "Jo"], ["1", "", ""]) == ["Jo (1)", "Jo [1]", "Jo [2]"]


def test_ten_thousand_of_one_name():
    found = unique_names(["Li Wei"] * 10_000, [""] * 10_000)
    assert found[-1] == "Li Wei [10000]" and len(set(found)) == 10_000


def test_folders_of_devices_and_of_names_that_look_like_ours():
    for name in (*DEVICES, "gradebook.csv", "INDEX.html", "similarity.html", "ends in blank .", "a" * 300):
        assert folder_name(name) != name and len(folder_name(name).encode()) <= LONGEST + 9
    victim = folder_name("a/b")
    assert folder_name(victim) != victim, "nobody's name is the folder of somebody else"


def test_every_trouble_in_a_folder_and_in_a_zip(exercise, tmp_path):
    count = len(TROUBLES) + 20
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as packed:
        for number, name in enumerate(itertools.islice(names(), count)):
            packed.writestr(f"{name}_{number}_assignsubmission_file_/{FILE}", b"x = 1\n")
    (tmp_path / "class.zip").write_bytes(archive.getvalue())
    for place in (hand_in(tmp_path / "class", count), tmp_path / "class.zip"):
        with ExitStack() as stack:
            found, left_out = find_submissions(place, exercise, stack)
            students = [each.student for each in found]
            assert len(found) == count and left_out == [], place
            assert (
                len({folded(name) for name in students})
                == len({folded(folder_name(name)) for name in students})
                == count
            )
            assert all(name.isprintable() for name in students)
            assert len({each.id for each in found}) >= count - 1, (
                "ids are read; a backslash in a zip ends a folder's name"
            )


def test_a_generated_class_has_two_hundred_different_texts():
    assert len(set(texts())) == len(texts()) == 200
    for text in texts():
        compile(text, FILE, "exec")
