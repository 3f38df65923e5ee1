"""Look into a recording: `gz tlog -i FILE`, `gz tlog -e FILE -t /topic`.

FILE is a `state.tlog` of `gz sim --record`, a file of `gz log record`, or a folder with a `state.tlog`; times are in
[s]. This command does not exist in Gazebo; `gz log` records and plays back, as there.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser, whole_number
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.tlog import Log


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-i", "--info", metavar="FILE", help="topics, types, counts and times of a recording")
    parser.add_argument("-e", "--echo", metavar="FILE", help="print the messages of a topic")
    parser.add_argument("-t", "--topic", metavar="NAME", help="the topic to print")
    parser.add_argument("-n", "--num", type=whole_number, metavar="N", default=0, help="print N messages, then end")
    parser.commands("--info", "--echo")
    parser.needs("--echo", "--topic")


def run(values: argparse.Namespace) -> int:
    """Run `gz tlog`; return the exit code. Raises ValueError with one sentence if the file is no log."""
    try:
        log = Log(Path(values.info or values.echo))
    except SimError as error:
        raise ValueError(str(error)) from None
    with log:
        return _info(log) if values.info else _echo(log, values.topic, values.num)


def _info(log: Log) -> int:
    topics = log.topics()
    print(f"Version:    {log.version}")
    if topics:
        first, last = min(each.first_ns for each in topics), max(each.last_ns for each in topics)
        print(f"Start:      {first * 1e-9:.3f} s")
        print(f"End:        {last * 1e-9:.3f} s")
    print(f"Messages:   {sum(each.count for each in topics)} ({sum(each.size for each in topics)} bytes)")
    print("Topics:")
    for each in topics:
        print(f"  {each.topic} [{each.type_name}] {each.count}")
    return 0


def _echo(log: Log, topic: str, most: int) -> int:
    from gz_course.sim.gz.msgs import message_class
    from gz_course.sim.gz.msgs.text import to_text

    known = [each.topic for each in log.topics()]
    if topic not in known:
        raise ValueError(f"{log.path} has nothing of topic [{topic}]{did_you_mean(topic, known)}")
    for number, entry in enumerate(log.messages(topic)):
        if most and number >= most:
            break
        message = message_class(entry.type_name)()
        message.ParseFromString(entry.data)
        sys.stdout.write(f"{to_text(message)}\n")
    return 0
