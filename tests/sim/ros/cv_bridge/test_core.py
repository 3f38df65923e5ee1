"""CvBridge: messages become arrays and arrays messages, with padding, byte order and the errors of the original."""

import contextlib
import sys
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from gz_course.sim.ros.cv_bridge import CvBridge, CvBridgeError, getCvType
from gz_course.sim.ros.cv_bridge.boost.cv_bridge_boost import CV_MAT_CNWrap, CV_MAT_DEPTHWrap, cvtColor2
from gz_course.sim.ros.cv_bridge.encodings import COLOR_FORMATS

BRIDGE = CvBridge()
TYPES = ["uint8", "int8", "uint16", "int16", "int32", "float32", "float64"]
GENERIC = [f"{depth}C{n}" for depth in ("8U", "8S", "16U", "16S", "32S", "32F", "64F") for n in (1, 2, 3, 4)]
EVERY = [*COLOR_FORMATS, *GENERIC]
images = st.tuples(st.sampled_from(TYPES), st.integers(1, 4), st.integers(1, 5), st.integers(1, 5)).flatmap(
    lambda t: arrays.arrays(t[0], (t[2], t[3], t[1]) if t[1] > 1 else (t[2], t[3]))
)


def message(image, encoding, *, padding=0, big=False):
    """Return a message whose rows end with padding, built byte by byte."""
    swapped = image.astype(image.dtype.newbyteorder(">" if big else "<"))
    rows = [row.tobytes() + b"\xaa" * padding for row in swapped]
    return Image(
        height=image.shape[0],
        width=image.shape[1],
        encoding=encoding,
        step=len(rows[0]),
        is_bigendian=int(big),
        data=b"".join(rows),
    )


@given(images)
def test_an_image_survives_the_way_there_and_back(image):
    there = BRIDGE.cv2_to_imgmsg(image)
    assert (there.height, there.width) == image.shape[:2]
    assert there.step * there.height == len(there.data) == image.nbytes
    back = BRIDGE.imgmsg_to_cv2(there)
    assert back.dtype == image.dtype and back.tobytes() == image.tobytes() and back.shape == image.shape
    assert BRIDGE.imgmsg_to_cv2(there, there.encoding).tobytes() == image.tobytes()


@given(images, st.integers(0, 7), st.booleans())
def test_padding_and_byte_order_are_seen_through(image, padding, big):
    if padding % (image.itemsize * (1 if image.ndim == 2 else image.shape[2])):
        padding *= image.itemsize * 12  # rows end with a whole pixel
    encoding = BRIDGE.cv2_to_imgmsg(image).encoding
    read = BRIDGE.imgmsg_to_cv2(message(image, encoding, padding=padding, big=big))
    assert read.dtype.isnative and read.flags.c_contiguous
    assert read.tobytes() == image.tobytes() and read.shape == image.shape


def test_a_picture_of_the_same_encoding_shares_memory_only_if_nothing_is_asked_for():
    there = BRIDGE.cv2_to_imgmsg(np.zeros((2, 2, 3), np.uint8), "bgr8", Header(frame_id="camera"))
    BRIDGE.imgmsg_to_cv2(there)[0, 0, 0] = 7
    assert there.data[0] == 7 and there.header.frame_id == "camera"
    copy = BRIDGE.imgmsg_to_cv2(there, "bgr8")
    copy[:] = 1
    assert list(there.data[:4]) == [7, 0, 0, 0]


def test_big_endian_arrays_are_marked():
    image = np.array([[1, 258]], ">u2")
    there = BRIDGE.cv2_to_imgmsg(image, "mono16")
    assert there.is_bigendian and list(there.data) == [0, 1, 1, 2]
    assert BRIDGE.imgmsg_to_cv2(there).tolist() == [[1, 258]]
    assert not BRIDGE.cv2_to_imgmsg(image.astype("=u2")).is_bigendian or sys.byteorder == "big"


def test_a_slice_is_written_row_by_row():
    image = np.arange(24, dtype=np.uint8).reshape(4, 6)[::2, 1::2]
    assert list(BRIDGE.cv2_to_imgmsg(image, "mono8").data) == [1, 3, 5, 13, 15, 17]


def test_numbers_of_types_are_those_of_opencv():
    # CV_8UC3, CV_16UC1, CV_64FC4, CV_8UC2 of OpenCV 4
    assert [getCvType(name) for name in ("bgr8", "mono16", "64FC4", "yuv422")] == [16, 2, 30, 8]
    assert BRIDGE.cvtype_to_name[16] == "8UC3" and len(BRIDGE.cvtype_to_name) == 28
    assert BRIDGE.cvtype2_to_dtype_with_channels(21) == ("float32", 3)
    assert (CV_MAT_CNWrap(16), CV_MAT_DEPTHWrap(21)) == (3, 5)
    assert BRIDGE.dtype_with_channels_to_cvtype2(np.dtype("int16"), 2) == "16SC2"
    assert BRIDGE.encoding_to_cvtype2("bayer_rggb16") == 2
    expected = {"rgba16": ("uint16", 4), "8UC10": ("uint8", 10), "32F": ("float32", 1), "yuv422_yuy2": ("uint8", 2)}
    assert {name: BRIDGE.encoding_to_dtype_with_channels(name) for name in expected} == expected


@pytest.mark.parametrize(
    ("source", "target", "words"),
    [
        ("16UC1", "bgr8", "[16UC1] is not a color format. but [bgr8] is. The conversion does not make sense"),
        ("8UC3", "bgr8", "[8UC3] is not a color format. but [bgr8] is. The conversion does not make sense"),
        ("32FC1", "8UC3", "[32FC1] and [8UC3] do not have the same number of channel"),
        ("bgr8", "8UC1", "[bgr8] is a color format but [8UC1] is not so they must have the same OpenCV type"),
        ("bgr8", "bayer_rggb8", "Unsupported conversion from [bgr8] to [bayer_rggb8]"),
        ("bayer_rggb8", "bgra8", "Unsupported conversion from [bayer_rggb8] to [bgra8]"),
        ("mono8", "yuv422", "Unsupported conversion from [mono8] to [yuv422]"),
        ("bgr8", "bgr", "Unknown encoding bgr; did you mean 'bgr8'?"),
        ("bgr-8", "bgr8", "Unrecognized image encoding [bgr-8]; did you mean 'bgr8'?"),
        ("8UC0", "passthrough", "Unrecognized image encoding [8UC0]"),
        ("8UC9999999999999999999", "passthrough", "Unrecognized image encoding [8UC999"),
    ],
)
def test_a_conversion_that_does_not_exist(source, target, words):
    data = np.zeros(2 * 2 * 16, np.uint8)
    with pytest.raises(CvBridgeError) as caught:
        BRIDGE.imgmsg_to_cv2(Image(height=2, width=2, step=32, encoding=source, data=data.tobytes()), target)
    assert str(caught.value).startswith(words)


def test_other_errors():
    with pytest.raises(TypeError, match="Your input type is not a numpy array"):
        BRIDGE.cv2_to_imgmsg([[1]])
    with pytest.raises(CvBridgeError, match="encoding specified as bgr8, but image has incompatible type 8UC1"):
        BRIDGE.cv2_to_imgmsg(np.zeros((2, 2), np.uint8), "bgr8")
    with pytest.raises(KeyError, match="int64"):
        BRIDGE.cv2_to_imgmsg(np.zeros((2, 2), np.int64))
    with pytest.raises(TypeError, match="buffer is too small for requested array"):
        BRIDGE.imgmsg_to_cv2(Image(height=3, width=2, step=2, encoding="mono8", data=[0] * 5))
    with pytest.raises(CvBridgeError, match="an even width, not 3"):
        BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(np.zeros((2, 3, 2), np.uint8), "yuv422"), "bgr8")
    with pytest.raises(RuntimeError, match="one channel"):
        cvtColor2(np.zeros((2, 2), np.uint8), "bgr8", "mono8")


@given(st.data(), st.sampled_from(list(product(EVERY, EVERY))))
def test_every_pair_of_encodings_is_converted_or_refused(data, pair):
    source, target = pair
    dtype, channels = BRIDGE.encoding_to_dtype_with_channels(source)
    shape = (3, 4) if channels == 1 else (3, 4, channels)
    there = BRIDGE.cv2_to_imgmsg(data.draw(arrays.arrays(dtype, shape)), source)
    try:
        out = BRIDGE.imgmsg_to_cv2(there, target)
    except CvBridgeError:
        return
    dtype, channels = BRIDGE.encoding_to_dtype_with_channels(target)
    assert (out.dtype.name, out.shape) == (dtype, (3, 4) if channels == 1 else (3, 4, channels))


names = st.sampled_from(EVERY) | st.text(max_size=8)


@given(names, names, *[st.integers(0, 9)] * 3, st.binary(max_size=40), st.booleans())
def test_no_message_does_worse_than_a_type_error(source, target, height, width, step, data, big):
    hostile = Image(height=height, width=width, step=step, encoding=source, data=data, is_bigendian=int(big))
    with contextlib.suppress(TypeError):
        BRIDGE.imgmsg_to_cv2(hostile, target)


@pytest.mark.parametrize("name", ["png", "bmp", "tiff", "jp2", "webp", "ppm"])
def test_pictures_without_loss(name):
    image = np.random.default_rng(3).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    there = BRIDGE.cv2_to_compressed_imgmsg(image, name)
    assert there.format == name
    assert BRIDGE.compressed_imgmsg_to_cv2(there).tolist() == image.tolist()
    assert BRIDGE.compressed_imgmsg_to_cv2(there, "rgb8").tolist() == image[:, :, ::-1].tolist()


def test_a_jpeg_is_similar_and_gray_stays_gray():
    image = np.repeat(np.linspace(20, 230, 16, dtype=np.uint8)[None], 16, axis=0)
    there = BRIDGE.cv2_to_compressed_imgmsg(image)
    assert there.format == "jpg" and bytes(there.data[:2]) == b"\xff\xd8"
    back = BRIDGE.compressed_imgmsg_to_cv2(there)
    assert back.shape == (16, 16) and np.abs(back.astype(int) - image).max() < 12


def test_alpha_is_dropped_and_sixteen_bits_become_eight():
    image = np.zeros((2, 3, 4), np.uint8)
    image[:] = (1, 2, 3, 9)
    for name in ("png", "jpg"):
        assert BRIDGE.compressed_imgmsg_to_cv2(BRIDGE.cv2_to_compressed_imgmsg(image, name)).shape == (2, 3, 3)
    deep = np.array([[65535, 300, 255]], np.uint16)
    assert BRIDGE.compressed_imgmsg_to_cv2(BRIDGE.cv2_to_compressed_imgmsg(deep, "png")).tolist() == [[255, 1, 0]]


def test_pictures_that_cannot_be():
    nothing = CompressedImage(format="jpg", data=b"no picture")
    assert BRIDGE.compressed_imgmsg_to_cv2(nothing) is None
    with pytest.raises(CvBridgeError, match="no picture that can be read"):
        BRIDGE.compressed_imgmsg_to_cv2(nothing, "bgr8")
    with pytest.raises(CvBridgeError, match="no picture format 'jpgg'; did you mean 'jpg'"):
        BRIDGE.cv2_to_compressed_imgmsg(np.zeros((2, 2), np.uint8), "jpgg")
    with pytest.raises(CvBridgeError, match="needs 1, 3 or 4 channels"):
        BRIDGE.cv2_to_compressed_imgmsg(np.zeros((2, 2, 2), np.uint8))
    with pytest.raises(TypeError, match="not a numpy array"):
        BRIDGE.cv2_to_compressed_imgmsg("picture")
