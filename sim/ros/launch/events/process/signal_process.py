"""The event that sends a signal to a process."""

from __future__ import annotations

import signal
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.events.process.process_targeted_event import ProcessTargetedEvent


class SignalProcess(ProcessTargetedEvent):
    """Sends a signal, given by number or name, to a process and its whole process group."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | int | signal.Signals, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        names = signal.Signals.__members__
        if isinstance(signal_number, str) and signal_number not in names:
            hint = did_you_mean(signal_number, names, listing="there are")
            raise ValueError(f"there is no signal {signal_number!r}{hint}")
        self.signal = names[signal_number] if isinstance(signal_number, str) else signal.Signals(signal_number)
        self.signal_name = self.signal.name
