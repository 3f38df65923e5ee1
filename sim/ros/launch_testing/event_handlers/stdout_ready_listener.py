"""The event handler for a text that tells that a process is ready."""

from __future__ import annotations

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.event_handlers import OnProcessIO
from gz_course.sim.ros.launch.events.process import ProcessIO
from gz_course.sim.ros.launch.launch_description_entity import listed
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType


class StdoutReadyListener(OnProcessIO):
    """Visits `actions` when a process prints `ready_txt` on stdout."""

    def __init__(self, *, target_action: ExecuteLocal | None = None, ready_txt: str, actions: SomeEntitiesType) -> None:
        self._ready_text = ready_txt
        self._actions = listed(actions, "actions of StdoutReadyListener")
        super().__init__(target_action=target_action, on_stdout=self._on_stdout)
        self.entities = self._actions  # for those who look into the launch description

    def _on_stdout(self, event: ProcessIO) -> SomeEntitiesType | None:
        return self._actions if self._ready_text in event.text.decode(errors="replace") else None
