"""Files of a run: a picture (PNG, JPEG) of one moment, a film (GIF, MP4) of all of it.

Source: https://pyav.basswood-io.com (how a film is encoded)
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.grader.errors import UsageError
from gz_course.grader.record.reading import Recording

if TYPE_CHECKING:
    from PIL.Image import Image

PICTURES, FILMS = (".png", ".jpg", ".jpeg"), (".gif", ".mp4")
SMALLEST, LARGEST = 64, 4096  # [px]
MOST_FRAMES = 10_000
BITS = "23"  # quality of H.264 (CRF)


def snapshot(recording: Recording, at_s: float, out: Path, size: tuple[int, int]) -> None:
    """Write the picture of a moment [s] of simulated time. Raises UsageError for what cannot be done."""
    from gz_course.grader.film.picture import Pictures

    _check_out(out, PICTURES, "picture")
    end = _end_s(recording)
    if not 0.0 <= at_s <= end:
        raise UsageError(f"--at {at_s:g} is outside of the recording, which goes from 0 to {end:g} s")
    with contextlib.closing(Pictures(recording, *_checked(size))) as pictures, _written(out) as part:
        pictures.at(round(at_s * 1e9)).save(part, "PNG" if out.suffix.lower() == ".png" else "JPEG")


def film(
    recording: Recording,
    out: Path,
    size: tuple[int, int],
    frames_per_second: float,
    start_s: float = 0.0,
    end_s: float | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> int:
    """Write the film of a run, at the speed of simulated time; return its number of pictures.

    `progress` is told the share that is done. Raises UsageError for what cannot be done.
    """
    from gz_course.grader.film.picture import Pictures

    _check_out(out, FILMS, "film")
    last = _end_s(recording)
    end_s = last if end_s is None else end_s
    if not 0.0 <= start_s < end_s <= last:
        raise UsageError(
            f"from {start_s:g} to {end_s:g} s is no part of the recording, which goes from 0 to {last:g} s"
        )
    if not 1.0 <= frames_per_second <= 60.0:
        raise UsageError(f"--fps must be between 1 and 60, not {frames_per_second:g}")
    count = int((end_s - start_s) * frames_per_second) + 1
    if count > MOST_FRAMES:
        raise UsageError(f"that would be {count} pictures; {MOST_FRAMES} is the most, so choose a part (--from, --to)")
    write = _write_gif if out.suffix.lower() == ".gif" else _mp4_writer()
    with contextlib.closing(Pictures(recording, *_checked(size))) as pictures, _written(out) as part:

        def frames() -> Iterator[Image]:
            for number in range(count):
                yield pictures.at(round((start_s + number / frames_per_second) * 1e9))
                progress((number + 1) / count)

        write(part, frames(), frames_per_second)
    return count


def _write_gif(path: Path, frames: Iterator[Image], frames_per_second: float) -> None:
    """Write a GIF; its colours are those of the first picture and of the scan, so that they do not flicker."""
    from PIL.Image import Dither

    palette = next(frames).quantize(160, dither=Dither.NONE)
    rest = (each.quantize(palette=palette, dither=Dither.NONE) for each in frames)
    palette.save(
        path, "GIF", save_all=True, append_images=rest, duration=round(1000 / frames_per_second), loop=0, optimize=False
    )


def _mp4_writer() -> Callable[[Path, Iterator[Image], float], None]:
    try:
        import av
    except ImportError:
        raise UsageError(
            "an MP4 needs PyAV: pip install 'gz-ros2-course[video]'; a GIF (--out NAME.gif) needs nothing more"
        ) from None

    def write(path: Path, frames: Iterator[Image], frames_per_second: float) -> None:
        from fractions import Fraction

        rate = Fraction(frames_per_second).limit_denominator(1000)
        with av.open(str(path), "w", format="mp4") as file:
            stream = None
            for each in frames:
                if stream is None:
                    stream = file.add_stream("libx264", rate=rate, options={"crf": BITS})
                    stream.width, stream.height, stream.pix_fmt = each.width, each.height, "yuv420p"
                file.mux(stream.encode(av.VideoFrame.from_image(each)))
            if stream is not None:
                file.mux(stream.encode())

    return write


def _end_s(recording: Recording) -> float:
    """Return the end of simulated time in a recording [s]; verdicts are recorded a little beyond it."""
    poses = [recording.poses(entity) for entity in recording.entities("world", "Transform3D")]
    return max((int(each.times[-1]) / 1e9 for each in poses if each is not None), default=0.0)


def _checked(size: tuple[int, int]) -> tuple[int, int]:
    width, height = size
    if not (SMALLEST <= width <= LARGEST and SMALLEST <= height <= LARGEST):
        raise UsageError(f"--size must be between {SMALLEST}x{SMALLEST} and {LARGEST}x{LARGEST}, not {width}x{height}")
    return width - width % 2, height - height % 2  # H.264 takes even numbers only


def size_of(text: str) -> tuple[int, int]:
    """Return width and height of a text such as `640x360`. Raises UsageError for another one."""
    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal() and len(text) < 20):
        raise UsageError(f"--size must be like 640x360, not {text!r}")
    return int(width), int(height)


def _check_out(out: Path, endings: tuple[str, ...], noun: str) -> None:
    """Raise UsageError unless a file of such a kind can be written there."""
    if out.suffix.lower() not in endings:
        raise UsageError(f"{out} does not say what kind of {noun} it is; end its name with {' or '.join(endings)}")
    if out.is_dir() or not out.parent.is_dir():
        reason = "it is a folder" if out.is_dir() else f"there is no folder {out.parent}"
        raise UsageError(f"{out} cannot be written: {reason}")
    if not os.access(out.parent, os.W_OK):
        raise UsageError(f"{out} cannot be written: the folder {out.parent} may not be written to")


@contextlib.contextmanager
def _written(out: Path) -> Iterator[Path]:
    """Yield a name to write to, which becomes `out` only when it is complete."""
    part = out.with_name(f".{out.name}.part")
    try:
        yield part
        part.replace(out)
    except OSError as error:
        raise UsageError(f"{out} cannot be written: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
