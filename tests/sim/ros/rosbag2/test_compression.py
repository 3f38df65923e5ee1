"""Bags whose files or messages are compressed: written, read, built anew, and refused when they are damaged."""

import gc
import tempfile
from pathlib import Path

import pytest
import yaml
import zstandard

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage import bag_writer, compression
from gz_course.sim.ros.rosbag2.storage.bag import Bag, reindex
from gz_course.tests.sim.ros.rosbag2.bags import START, string, twist, write_bag


@pytest.fixture(autouse=True)
def folder_for_unpacking(tmp_path, monkeypatch):
    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
@pytest.mark.parametrize("mode", ["file", "message"])
def test_a_compressed_bag_is_read_as_it_was_written(tmp_path, storage, mode):
    folder = write_bag(tmp_path / "c", storage=storage, compression=mode, split_bytes=4096)
    told = yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert (told["compression_mode"], told["compression_format"]) == (mode.upper(), "zstd")
    suffix = {"mcap": ".mcap", "sqlite3": ".db3"}[storage] + (".zstd" if mode == "file" else "")
    assert told["relative_file_paths"][0] == f"c_0{suffix}"
    there = {path.name for path in folder.iterdir()} - {"metadata.yaml"}
    assert there == set(told["relative_file_paths"])
    bag = Bag(folder)
    assert bag.complaints == []
    assert [m.data for m in bag.messages()] == [string(f"message {n}") if n % 2 == 0 else twist(n) for n in range(100)]
    (folder / "metadata.yaml").unlink()
    rebuilt = reindex(folder)
    assert (rebuilt.compression_mode, rebuilt.compression_format, rebuilt.count) == (mode.upper(), "zstd", 100)
    del bag
    gc.collect()
    assert list((tmp_path / "tmp").iterdir()) == []


def test_only_the_last_files_are_kept_and_splits_are_told(tmp_path):
    writer = bag_writer.BagWriter(tmp_path / "k", compression="file", split_ns=10, keep=2)
    told = []
    writer.on_split = lambda *paths: told.append([Path(path).name.split(".")[0] for path in paths])
    from gz_course.tests.sim.ros.rosbag2.bags import SAID

    writer.add_topic(SAID, ("ros2msg", "string data\n"))
    for number in range(4):
        writer.write("/chatter", START + 10 * number, 0, string(str(number)))
    writer.close()
    assert told == [["k_0", "k_1"], ["k_1", "k_2"], ["k_2", "k_3"]]
    assert [m.data for m in Bag(tmp_path / "k").messages()] == [string("2"), string("3")]


def test_a_file_that_cannot_be_compressed_stays_as_it_is(tmp_path, monkeypatch):
    def full(path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(bag_writer, "compress_file", full)
    folder = write_bag(tmp_path / "f", count=4, compression="file")
    assert sorted(path.name for path in folder.iterdir()) == ["f_0.mcap", "metadata.yaml"]
    assert len(list(Bag(folder).messages())) == 4


def test_an_interrupted_compression_leaves_every_message_once(tmp_path):
    folder = write_bag(tmp_path / "i", count=4, split_bytes=0)
    whole = (folder / "i_0.mcap").read_bytes()
    compression.compress_file(folder / "i_0.mcap")
    (folder / "i_0.mcap").write_bytes(whole)
    (folder / "i_1.mcap.zstd.part").write_bytes(b"half")
    (folder / "metadata.yaml").unlink()
    assert len(list(Bag(folder).messages())) == 4


def test_damaged_and_hostile_ones_are_refused(tmp_path, monkeypatch):
    path = tmp_path / "x.mcap.zstd"
    whole = (write_bag(tmp_path / "w", count=50) / "w_0.mcap").read_bytes()
    packed = zstandard.ZstdCompressor().compress(whole)
    path.write_bytes(zstandard.ZstdCompressor().compress(whole[:-200]))
    assert "is not whole" in Bag(path).complaints[0]
    for content in (packed[:-20], zstandard.ZstdCompressor().compress(b"no bag")):
        path.write_bytes(content)
        with pytest.raises(BagError, match=r"x.mcap.zstd is no file of a bag"):
            Bag(path)
    path.write_bytes(packed[:6] + b"\xff" * 20 + packed[26:])
    with pytest.raises(BagError, match=r"x.mcap.zstd is damaged"):
        Bag(path)
    path.write_bytes(packed)
    monkeypatch.setattr(compression.shutil, "disk_usage", lambda folder: type("Usage", (), {"free": 100}))
    with pytest.raises(BagError, match="unpacks to more than half of the free space"):
        Bag(path)
    bomb = zstandard.ZstdCompressor().compress(b"")[:4] + b"\xe0" + b"\xff" * 8 + b"\x01\x00\x00"
    for data in (bomb, compression.MAGIC, compression.MAGIC + b"\0" * 30):
        with pytest.raises(BagError, match=r"a message of '/x' (claims to have|is damaged)"):
            compression.unpack_message(data, "/x")
