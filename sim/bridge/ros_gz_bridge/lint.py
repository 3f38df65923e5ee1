"""The program `ros2 run ros_gz_bridge lint bridge.yaml`, which checks the configuration of a bridge.

It also accepts the arguments of `parameter_bridge`. It prints the findings that `parameter_bridge` would report at its
start, one per line; the exit code is 2 if there are errors among them, else 0. `parameter_bridge --strict` refuses what
is an error here; without `--strict` it goes on where the original does.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.terminal_text import guard

if TYPE_CHECKING:
    from gz_course.sim.bridge.ros_gz_bridge.config import Config

HELP = """\
usage: lint [--compat] FILE ...
       lint [--compat] 'TOPIC@ROS_TYPE@GZ_TYPE' ...

Checks the YAML files (or the arguments) of a bridge between Gazebo and ROS 2 and starts nothing.
Each finding is one line: FILE:LINE: error: ... or FILE:LINE: warning: ...
Exit code: 0 without errors (there may be warnings), 2 with errors.

  --compat  report what the original ros_gz_bridge ignores as a warning, not as an error
"""


def main(argv: list[str] | None = None) -> int:
    """Check what the command line names; return the exit code."""
    if argv is None:
        guard()
    arguments = sys.argv[1:] if argv is None else argv
    if not arguments or {"-h", "--help"} & set(arguments):
        print(HELP, end="")
        return 0 if arguments else 2
    compat = "--compat" in arguments
    words = [word for word in arguments if word != "--compat"]
    unknown = [word for word in words if word.startswith("-")]
    for option in unknown:
        print(f"lint: the option {option} is not known (see --help)", file=sys.stderr)
    if unknown or not words:
        if not words:
            print("lint: nothing to check; name a YAML file (see --help)", file=sys.stderr)
        return 2
    try:
        return _report(words, compat)
    except BrokenPipeError:  # the reader, for instance head, has ended
        sys.stderr.close()
        return 2


def _report(words: list[str], compat: bool) -> int:
    from gz_course.sim.bridge.ros_gz_bridge.finding import one_line

    errors = warnings = bridges = 0
    for config in _read(words):
        shown = config.tolerant() if compat else config
        for finding in shown.findings:
            kind = "warning" if finding.warning else "error"
            place = f"{one_line(finding.place)}: " if finding.place else ""
            print(f"{place}{kind}: {one_line(finding.sentence)}")
            errors += not finding.warning
            warnings += finding.warning
        bridges += len(shown.topics) + len(shown.services)
    print(f"{_number(errors, 'error')}, {_number(warnings, 'warning')}; {_number(bridges, 'bridge')} can be made")
    return 2 if errors else 0


def _read(words: list[str]) -> list[Config]:
    """Return one configuration for each file, and one for all arguments."""
    from gz_course.sim.bridge.ros_gz_bridge.arguments import read_arguments
    from gz_course.sim.bridge.ros_gz_bridge.checks import private_gz_names, volatile_static_transforms
    from gz_course.sim.bridge.ros_gz_bridge.config import read_file
    from gz_course.sim.bridge.ros_gz_bridge.finding import Finding

    arguments = [word for word in words if "@" in word and not Path(word[:1000]).exists()]
    read = [read_file(word) for word in words if word not in arguments]
    if arguments:
        read.append(read_arguments(arguments))
    for config in read:
        config.findings += [
            Finding(each.place, each.sentence, warning=True)
            for each in private_gz_names(config.topics, config.services)
        ]
        config.findings += volatile_static_transforms(config.topics)
    return read


def _number(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


if __name__ == "__main__":
    sys.exit(main())
