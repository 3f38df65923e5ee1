"""Loads damaged worlds: `python -m tests.fuzz.load_worlds [--cases 50000] [--first 0] [--jobs 2]`.

Each case is a number: it chooses a world (built in, or made up to hold every kind of element), damages it (values,
words, tags, elements, bare text), loads it and steps it 20 times. The world must load or be refused with one sentence
that starts with file and line; nothing else may be raised, the process must not end, and a case must not take longer
than DEADLINE. The cases run in child processes, so that a crash is one failed case. Exit code 0 when all is well, 1
with a list of cases when not; `--show CASE` prints a case's text.
"""

from __future__ import annotations

import argparse
import random
import re
import resource
import selectors
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from gz_course.tests.fuzz.worlds import WORLDS

DEADLINE = 20.0  # [s] one case
MEMORY = 6 * 1024**3  # [bytes] address space of a child
STEPS = 20
_NUMBERS_TEXT = """
0 -0 1 -1 0.5 2 1e-3 1e-9 1e-300 1e300 -1e300 1e6 -1e6 1e9 1e16 1e17 inf -inf nan 1e999 0x10 1,5 1e 3.4028236e38 true
99999999999999999999 -5 1000000 4294967296 2147483648 0.1 3.14159265358979 -3.14159265358979 abc 1e7 1e-6 12 0.05
"""
_WORDS_TEXT = """
world __model__ __root__ base link a b :: a::b true false 1 0 revolute prismatic ball fixed universal revolute2 screw
gearbox continuous box sphere mesh heightmap polyline plane cylinder cone capsule ellipsoid model static
../../../etc/passwd /dev/zero /dev/stdin file:///dev/urandom model:// package://x/y.stl http://x/y
"""
_NUMBERS = _NUMBERS_TEXT.split()
_WORDS = ["", *_WORDS_TEXT.split()]


def case(number: int) -> str:
    """Return the text of a case."""
    chance = random.Random(number)
    name = chance.choice(sorted(WORLDS))
    text = WORLDS[name]
    if chance.random() < 0.75:
        try:
            root = ET.fromstring(text)
        except ET.ParseError:
            root = None
        if root is not None:
            for _ in range(chance.choice((1, 1, 1, 2, 3, 6))):
                _damage_tree(root, chance)
            text = ET.tostring(root, encoding="unicode")
    if chance.random() < 0.35:
        for _ in range(chance.choice((1, 1, 2, 4))):
            text = _damage_text(text, chance)
    return text


def _damage_tree(root: ET.Element, chance: random.Random) -> None:
    elements = list(root.iter())
    element = chance.choice(elements)
    kind = chance.randrange(12)
    with_text = [each for each in elements if each.text and each.text.strip()]
    if kind < 5 and with_text:
        element = chance.choice(with_text)
        words = (element.text or "").split()
        pool = _NUMBERS if re.match(r"^[-+\d.]", words[0]) else _WORDS
        how = chance.randrange(6)
        if how == 0:
            element.text = chance.choice((*_NUMBERS, *_WORDS))
        elif how == 1:
            element.text = " ".join([*words, chance.choice(pool)])
        elif how == 2:
            element.text = " ".join(words[:-1])
        else:
            words[chance.randrange(len(words))] = chance.choice(pool)
            element.text = " ".join(words)
    elif kind == 5 and element.attrib:
        key = chance.choice(sorted(element.attrib))
        names = [each.get("name", "x") for each in elements]
        element.set(key, chance.choice((*_WORDS, *_NUMBERS, *names)))
    elif kind == 6 and len(element):
        element.remove(chance.choice(list(element)))
    elif kind == 7 and len(element):
        element.append(chance.choice(list(element)))
    elif kind == 8:
        other = chance.choice(elements)
        if element not in other.iter():
            element.append(other)
    elif kind == 9:
        element.tag = chance.choice(elements).tag
    elif kind == 10:
        key = chance.choice(
            ("relative_to", "attached_to", "expressed_in", "canonical_link", "merge", "auto", "degrees")
        )
        element.set(key, chance.choice((*_WORDS, *(each.get("name", "x") for each in elements))))
    elif len(element) > 1:
        children = list(element)
        chance.shuffle(children)
        element[:] = children


def _damage_text(text: str, chance: random.Random) -> str:
    at, length = chance.randrange(len(text) + 1), chance.choice((1, 1, 2, 5, 20, 200))
    how = chance.randrange(5)
    if how == 0:
        return text[:at] + text[at + length :]
    if how == 1:
        return text[:at] + "".join(chance.choice("<>/='\" \n&!-[]aé\x00\U0001f916") for _ in range(length)) + text[at:]
    if how == 2:
        return text[:at] + text[at : at + length] * chance.choice((2, 3, 50)) + text[at + length :]
    if how == 3:
        other = chance.randrange(len(text) + 1)
        return text[:at] + text[other : other + length] + text[at + length :]
    return text[:at]


def fault(text: str) -> str:
    """Load and step a text; return what went wrong ("" for a world that loads or is refused as it should be)."""
    from gz_course.sim.gz.sim.errors import SdfError, SimError
    from gz_course.sim.gz.sim.world import World

    try:
        world = World.from_string(text, file_name="case.sdf")
    except SdfError as error:
        sentence = str(error)
        if "\n" in sentence or not re.match(r"^\S+:\d+: .", sentence):
            return f"not a sentence with file and line: {sentence[:300]!r}"
        return ""
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:300]}"
    try:
        world.step(STEPS)
    except SimError as error:
        return "" if "\n" not in str(error) else f"not a sentence: {str(error)[:300]!r}"
    except Exception as error:
        return f"in a step, {type(error).__name__}: {str(error)[:300]}"
    finally:
        world.close()
    return ""


def _work(first: int, count: int) -> None:
    """The child: run cases one by one, saying which one is under way."""
    import logging

    logging.disable(logging.CRITICAL)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for number in range(first, first + count):
        print(f"start {number}", flush=True)
        wrong = fault(case(number))
        if wrong:
            print(f"wrong {number} {' '.join(wrong.split())}", flush=True)
    print("end", flush=True)


class _Child:
    """A child process that runs a range of cases; a new one takes over after a crash."""

    def __init__(self, first: int, count: int) -> None:
        self.next, self.end = first, first + count
        self.faults: list[tuple[int, str]] = []
        self._start()

    def _start(self) -> None:
        command = [
            sys.executable,
            "-m",
            "gz_course.tests.fuzz.load_worlds",
            "--work",
            str(self.next),
            str(self.end - self.next),
        ]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
        self.began = time.monotonic()
        self.running = self.next

    def read(self) -> bool:
        """Take one line; return False when all cases are done."""
        assert self.process.stdout is not None
        words = self.process.stdout.readline().split(maxsplit=2)
        if not words:
            return self._restart(f"the process ended with {self._end_name(self.process.wait())}")
        if words[0] == "start":
            self.running, self.began = int(words[1]), time.monotonic()
            self.next = self.running + 1
        elif words[0] == "wrong":
            self.faults.append((int(words[1]), words[2]))
        if words[0] == "end":
            self.process.wait(DEADLINE)  # it still has its files to clear away
            return False
        return True

    @staticmethod
    def _end_name(code: int) -> str:
        return signal.Signals(-code).name if code < 0 else f"exit code {code}"

    def late(self) -> bool:
        """Tell whether the case under way takes too long; end it and go on."""
        return time.monotonic() - self.began > DEADLINE

    def _restart(self, reason: str) -> bool:
        self.stop()
        self.faults.append((self.running, reason))
        self.next = max(self.next, self.running + 1)
        if self.next >= self.end:
            return False
        self._start()
        return True

    def give_up(self) -> bool:
        """End the case under way as too slow."""
        return self._restart(f"it took longer than {DEADLINE:g} s")

    def stop(self) -> None:
        """End the process and take what it left."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()


def run(first: int, cases: int, jobs: int = 1, say: bool = False) -> list[tuple[int, str]]:
    """Run the cases from `first` on; return the number and fault of each that went wrong."""
    share = -(-cases // jobs)
    children = [_Child(first + k * share, min(share, cases - k * share)) for k in range(jobs) if cases > k * share]
    faults: list[tuple[int, str]] = []
    alive = list(children)
    told = time.monotonic()
    try:
        while alive:
            with selectors.DefaultSelector() as selector:
                for child in alive:
                    selector.register(child.process.stdout, selectors.EVENT_READ, child)  # type: ignore[arg-type]
                ready = [key.data for key, _ in selector.select(1.0)]
            for child in list(alive):
                goes_on = child.read() if child in ready else child.give_up() if child.late() else True
                if not goes_on:
                    alive.remove(child)
            if say and time.monotonic() - told > 10.0:
                told = time.monotonic()
                left = sum(child.end - child.next for child in alive)
                print(f"{cases - left} cases, {sum(len(c.faults) for c in children)} faults", flush=True)
    finally:
        for child in children:
            child.stop()
            faults.extend(child.faults)
    return sorted(faults)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--cases", type=int, default=50_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--show", type=int)
    parser.add_argument("--work", type=int, nargs=2, help=argparse.SUPPRESS)
    return parser.parse_args()


def _lines(faults: list[tuple[int, str]]) -> Iterator[str]:
    for number, reason in faults:
        yield f"case {number}: {reason}"


def main() -> int:
    """Run the program; return its exit code."""
    arguments = _arguments()
    if arguments.work:
        with suppress(KeyboardInterrupt):
            _work(*arguments.work)
        return 0
    if arguments.show is not None:
        print(case(arguments.show))
        return 0
    faults = run(arguments.first, arguments.cases, arguments.jobs, say=True)
    print("\n".join(_lines(faults)) or f"{arguments.cases} damaged worlds: each was read or refused with a sentence")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    raise SystemExit(main())
