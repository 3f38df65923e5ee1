"""Archives as submissions: read like a folder, and refused in one sentence when they are made to do harm."""

import io
import struct
import tarfile
import zipfile

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.submission import archive, intake
from gz_course.grader.submission.intake import take_in

NODE = b"x = 1\n"
WANTED = {"teleop_node.py": NODE}


@pytest.fixture(scope="module")
def exercise(root):
    return find_exercise("03_teleop", root)


def zip_of(files, method=zipfile.ZIP_DEFLATED, change=None):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as packed:
        for name, data in files.items():
            info = zipfile.ZipInfo(name)
            info.compress_type = method
            if change:
                change(info)
            packed.writestr(info, data)
    return stream.getvalue()


def tar_of(files, mode="w:gz", change=None):
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode=mode) as packed:
        for name, data in files.items():
            info = tarfile.TarInfo(name)
            info.size = len(data)
            if change:
                change(info)
            packed.addfile(info, io.BytesIO(data))
    return stream.getvalue()


ARCHIVES = ["mine.zip", "mine.tar.gz", "mine.tgz", "mine.tar"]


def archive_of(name, files):
    return zip_of(files) if name.endswith(".zip") else tar_of(files, "w" if name.endswith(".tar") else "w:gz")


def taken(exercise, folder, name, data):
    path = folder / name
    path.write_bytes(data)
    return take_in(exercise, path)


def refused(exercise, folder, name, data, *words, kind=RefusedError):
    with pytest.raises(UsageError) as caught:
        taken(exercise, folder, name, data)
    told = str(caught.value)
    assert caught.type is kind, told
    assert [word for word in (name, *words) if word not in told] == [], told
    assert "\n" not in told and len(told) < 700


@pytest.mark.parametrize("name", ARCHIVES)
@pytest.mark.parametrize("inside", ["", "./", "Teleop (final)/", "a/b/c/"])
def test_an_archive_is_read_like_a_folder(exercise, tmp_path, name, inside):
    files = {f"{inside}teleop_node.py": NODE, f"{inside}lib/slow.py": b"y", "__MACOSX/._teleop_node.py": b"\0"}
    submission = taken(exercise, tmp_path, name, archive_of(name, files))
    assert submission.path == tmp_path / name
    assert (submission.main, submission.fault) == ("teleop_node.py", None)
    assert submission.files == WANTED | {"lib/slow.py": b"y"}


def test_backslashes_of_windows_are_folders(exercise, tmp_path):
    data = zip_of({"mine/teleop_node.py": NODE, "mine/lib/a.py": b""}).replace(b"mine/lib/", b"mine\\lib\\")
    assert set(taken(exercise, tmp_path, "w.zip", data).files) == {"teleop_node.py", "lib/a.py"}


def test_an_archive_alone_in_a_folder_or_archive_is_looked_into_once(exercise, tmp_path):
    inner = zip_of({"teleop_node.py": NODE})
    folder = tmp_path / "jane"
    folder.mkdir()
    (folder / "mine.zip").write_bytes(inner)
    assert take_in(exercise, folder).files == WANTED
    assert taken(exercise, tmp_path, "twice.zip", zip_of({"in.zip": inner})).files == WANTED
    refused(exercise, tmp_path, "deep.zip", zip_of({"a.zip": zip_of({"in.zip": inner})}), kind=UsageError)


@pytest.mark.parametrize("name", ["mine.zip", "mine.tar.gz"])
@pytest.mark.parametrize(
    "inside", ["../teleop_node.py", "/etc/teleop_node.py", "a/../../b.py", "C:\\teleop_node.py", "a\\..\\..\\b.py"]
)
def test_names_that_lead_out(exercise, tmp_path, name, inside):
    refused(exercise, tmp_path, name, archive_of(name, {"teleop_node.py": NODE, inside: NODE}), "leads out")


@pytest.mark.parametrize("kind", [tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.CHRTYPE, tarfile.BLKTYPE, tarfile.FIFOTYPE])
def test_links_and_devices_in_a_tar(exercise, tmp_path, kind):
    def change(info):
        if info.name == "odd":
            info.type, info.linkname, info.size = kind, "/etc/passwd", 0

    words = ["odd", "link" if kind in (tarfile.SYMTYPE, tarfile.LNKTYPE) else "device"]
    refused(exercise, tmp_path, "mine.tar.gz", tar_of({"teleop_node.py": NODE, "odd": b""}, change=change), *words)


@pytest.mark.parametrize(("mode", "word"), [(0o120777, "link"), (0o020666, "device"), (0o010666, "pipe")])
def test_links_and_devices_in_a_zip(exercise, tmp_path, mode, word):
    def change(info):
        info.external_attr = (mode if info.filename == "odd" else 0o100644) << 16

    refused(exercise, tmp_path, "m.zip", zip_of({"teleop_node.py": NODE, "odd": b"/etc"}, change=change), "odd", word)


def test_an_encrypted_file(exercise, tmp_path):
    data = bytearray(zip_of({"teleop_node.py": NODE}))
    data[6] |= 1  # in the local header, and in the central one
    data[data.index(b"PK\x01\x02") + 8] |= 1
    refused(exercise, tmp_path, "m.zip", bytes(data), "encrypted")


def test_a_packing_method_that_cannot_be_bounded(exercise, tmp_path):
    refused(exercise, tmp_path, "m.zip", zip_of({"teleop_node.py": NODE}, zipfile.ZIP_LZMA), "method 14")


@pytest.mark.parametrize("name", ["bomb.zip", "bomb.tar.gz"])
def test_a_bomb_that_says_how_large_it_is(exercise, tmp_path, name):
    data = archive_of(name, {"teleop_node.py": NODE, "bomb.bin": bytes(8 << 20)})
    assert len(data) < 20_000
    refused(exercise, tmp_path, name, data, "bomb.bin", str(8 << 20), str(intake.LARGEST))


def test_a_bomb_that_lies_about_its_size(exercise, tmp_path):
    size = (32 << 20) + 0x234567
    data = zip_of({"bomb.bin": bytes(size), "teleop_node.py": NODE})
    honest, lie = struct.pack("<I", size), struct.pack("<I", 1000)
    assert data.count(honest) == 2
    refused(exercise, tmp_path, "bomb.zip", data.replace(honest, lie), "bomb.bin", kind=UsageError)


def test_a_tar_that_unpacks_without_end(exercise, tmp_path, monkeypatch):
    monkeypatch.setattr(archive, "LARGEST_STREAM", 1 << 20)
    files = {"teleop_node.py": NODE} | {f"{n}/pad": bytes(1 << 19) for n in range(4)}
    refused(exercise, tmp_path, "bomb.tar.gz", tar_of(files), "too large", str(1 << 20))


@pytest.mark.parametrize("name", ["many.zip", "many.tar.gz"])
def test_a_hundred_thousand_files(exercise, tmp_path, monkeypatch, name):
    monkeypatch.setattr(archive, "MOST_MEMBERS", 300)
    refused(exercise, tmp_path, name, archive_of(name, {f"{n}": b"" for n in range(301)}), "too many", "300")


def test_too_many_files_of_a_zip_are_counted_before_it_is_opened(exercise, tmp_path, monkeypatch):
    def opened(*_):
        raise AssertionError("it was opened")

    monkeypatch.setattr(archive.zipfile, "ZipFile", opened)
    refused(exercise, tmp_path, "m.zip", b"PK\x01\x02" * (archive.MOST_MEMBERS + 1), "too many")


def test_an_archive_too_large_to_read(exercise, tmp_path):
    path = tmp_path / "big.zip"
    path.touch()
    with path.open("r+b") as stream:
        stream.truncate(500 << 20)
    with pytest.raises(RefusedError, match=f"{500 << 20} bytes; at most {archive.LARGEST_ARCHIVE}"):
        take_in(exercise, path)


@pytest.mark.parametrize("name", ["clash.zip", "clash.tar.gz"])
def test_a_file_below_a_file(exercise, tmp_path, name):
    files = {"teleop_node.py": NODE, "a": b"", "a/b/c.py": b""}
    refused(exercise, tmp_path, name, archive_of(name, files), "a/b/c.py", "below a file")


def test_a_name_longer_than_any_file(exercise, tmp_path):
    refused(exercise, tmp_path, "m.zip", zip_of({"teleop_node.py": NODE, "é" * 130: b""}), "too long a name")


@pytest.mark.parametrize("name", ["mine.rar", "mine.7z", "mine.tar.xz"])
def test_archives_that_are_not_opened(exercise, tmp_path, name):
    refused(exercise, tmp_path, name, b"Rar!", ".zip", kind=UsageError)


@pytest.mark.parametrize("name", ["broken.zip", "broken.tar.gz", "broken.tar"])
def test_what_is_no_archive(exercise, tmp_path, name):
    refused(exercise, tmp_path, name, b"not an archive at all" * 100, "cannot be read", kind=UsageError)


def test_control_codes_in_names_are_not_printed(exercise, tmp_path):
    with pytest.raises(UsageError) as caught:
        taken(exercise, tmp_path, "c.zip", zip_of({"../\x1b[2J": b""}))
    assert str(caught.value).isprintable()


NAMES = st.lists(
    st.sampled_from(["..", ".", "", "a", "teleop_node.py", "C:", "\\", "é", "x" * 300, "b.zip", ".git", "numpy.py"]),
    min_size=1,
    max_size=4,
).map("/".join)
TREES = st.dictionaries(NAMES.filter(lambda name: name.strip("/")), st.binary(max_size=20), max_size=5)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=150)
@given(TREES, st.sampled_from([zip_of, tar_of]), st.data())
def test_whatever_is_in_an_archive_only_safe_names_come_out(exercise, tmp_path, files, pack, data):
    packed = bytearray(pack(files))
    for place, value in data.draw(
        st.lists(st.tuples(st.integers(0, len(packed) - 1), st.integers(0, 255)), max_size=3)
    ):
        packed[place] = value
    try:
        submission = taken(exercise, tmp_path, "m.zip" if pack is zip_of else "m.tar.gz", bytes(packed))
    except UsageError as error:
        assert str(error).isprintable()
        return
    box = (tmp_path / "box").resolve()
    for name in submission.files:
        assert (box / name).resolve().is_relative_to(box) and (box / name).resolve() != box
        assert not any(name.startswith(f"{other}/") for other in submission.files)
    assert submission.main in submission.files
