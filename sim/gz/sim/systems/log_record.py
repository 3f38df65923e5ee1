"""LogRecord: records topics of the world into Gazebo's log file `state.tlog`; a plugin of the world.

`gz sim --record` adds it. It records the poses (`/world/W/pose/info`, `/world/W/dynamic_pose/info`), the initial world
as SDF (`/W/log/sdf`), and every topic whose whole name matches one of the `<record_topic>` patterns. A recorded sensor
counts as subscribed. `gz tlog` (`gz.sim.tlog`) reads the file.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/log/LogRecord.cc
"""

from __future__ import annotations

import re
import shutil
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.errors import LOG, SimError
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf_generator import generate_world
from gz_course.sim.gz.sim.tlog import FILE_NAME, Entry, LogWriter

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_LOOK_NS = 100_000_000
"""Period [ns] of simulated time at which it searches for new topics."""


@system("LogRecord", "gz-sim-log-record-system")
class LogRecord(System):
    """Writes one folder per run. Parameters: record_path (or path), record_topic (several), overwrite,
    record_period.
    """

    parameters = frozenset(["record_path", "path", "record_topic", "overwrite", "record_period", "compress"])

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters. Raises SdfError for an invalid pattern."""
        element = plugin.element
        if model is not None:
            raise element.error("LogRecord belongs directly in the <world>, not inside a <model>")
        self._world = world
        self._allowed = world.resources.opens_files
        if not self._allowed:
            world.diagnostics.warn(element.where, "LogRecord writes no file here, nothing is recorded")
        self._writer: LogWriter | None = None
        self._patterns = [re.compile(re.escape(f"{world.topic}/") + "(dynamic_)?pose/info")]
        if self._allowed:
            self._patterns += (_pattern(each) for each in element.all("record_topic") if each.text)
        self._state = self._patterns[0]
        path = element.text_of("record_path") or element.text_of("path")
        self.folder = Path(path) if path else _default_folder()
        self._overwrite = element.flag("overwrite", False)
        period = element.number("record_period", 0.0)
        if not 0.0 <= period < 1e6:
            raise element.error(f"<record_period> must be zero or more seconds, got {period}")
        self._period_ns = round(period * 1e9)
        self._last: dict[str, int] = {}

    def connect(self, node: Node) -> None:
        """Open the log and subscribe to the existing topics."""
        from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

        self._node, self._known, self._next_look_ns = node, set[str](), 0
        if not self._allowed:
            return
        self.folder = _free_folder(self.folder, self._overwrite)
        self._writer = LogWriter(self.folder / FILE_NAME)
        LOG.info("recording into %s", self.folder)
        text = StringMsg(data=generate_world(self._world)).SerializeToString()
        self._write(f"/{self._world.name}/log/sdf", StringMsg.DESCRIPTOR.full_name, text)

    def start(self) -> None:
        """Search for topics at the next step, also after the clock was reset."""
        self._next_look_ns = 0
        self._last.clear()

    def pre_update(self, info: UpdateInfo) -> None:
        if self._writer is None or info.sim_time_ns < self._next_look_ns:
            return
        self._next_look_ns = info.sim_time_ns + _LOOK_NS
        for topic in _own_topics(self._node):
            if topic not in self._known and any(pattern.fullmatch(topic) for pattern in self._patterns):
                self._known.add(topic)
                self._node.subscribe_raw(topic, self._on_message)

    def close(self) -> None:
        writer, self._writer = self._writer, None
        if writer is not None:
            try:
                writer.close()
            except SimError as error:
                LOG.error("%s", error)

    def _on_message(self, data: bytes, info: Any) -> None:
        topic, now = info.topic, self._world.sim_time_ns
        if self._period_ns and self._state.fullmatch(topic):
            last = self._last.get(topic)
            if last is not None and 0 <= now - last < self._period_ns:
                return
            self._last[topic] = now
        self._write(topic, info.type, data)

    def _write(self, topic: str, type_name: str, data: bytes) -> None:
        if self._writer is None:
            return
        try:
            self._writer.write(Entry(topic, type_name, self._world.sim_time_ns, data))
        except SimError as error:
            LOG.error("%s; recording ends here", error)
            self._writer = None


def _pattern(element: Element) -> re.Pattern[str]:
    try:
        return re.compile(element.text)
    except re.error as error:
        raise element.error(f"<record_topic> '{element.text}' is not a regular expression ({error})") from None


def _own_topics(node: Node) -> list[str]:
    """Return the topics of this process, which need no discovery."""
    from gz_course.sim.gz.transport import Scope

    options = node.options
    options.scope = Scope.PROCESS
    with type(node)(options) as local:
        return local.topic_list()


def _default_folder() -> Path:
    return Path.home() / ".gz" / "sim" / "log" / time.strftime("%Y-%m-%dT%H:%M:%S")


def _free_folder(folder: Path, overwrite: bool) -> Path:
    """Return the folder to write to: with `overwrite` an existing one without its old log, else `folder(1)`, ..."""
    if overwrite and folder.is_dir():
        for old in folder.glob(FILE_NAME + "*"):
            shutil.rmtree(old) if old.is_dir() else old.unlink()
        return folder
    chosen, number = folder, 0
    while chosen.exists():
        number += 1
        chosen = folder.with_name(f"{folder.name}({number})")
    if number:
        LOG.warning("%s exists already, so %s is recorded into; --log-overwrite uses the old one", folder, chosen)
    return chosen
