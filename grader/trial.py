"""A trial: the parameters of one run that a seed decides. Same seed, same run."""

from __future__ import annotations

import dataclasses
import random
from dataclasses import dataclass

from grader.exercise import ScriptedCommand

SCRIPT_SPREAD = 0.2  # a scripted speed is varied by at most this fraction


@dataclass(frozen=True)
class Trial:
    """One run's parameters. `seed` feeds the simulator's sensor noise and varies the scripted commands."""

    name: str
    seed: int

    def vary(self, command: ScriptedCommand) -> ScriptedCommand:
        """Return the command with its speeds scaled by factors drawn from this trial's seed."""
        draw = random.Random(f"{self.seed} {command.at} {command.topic}")
        return dataclasses.replace(
            command,
            linear_x=command.linear_x * draw.uniform(1 - SCRIPT_SPREAD, 1 + SCRIPT_SPREAD),
            angular_z=command.angular_z * draw.uniform(1 - SCRIPT_SPREAD, 1 + SCRIPT_SPREAD),
        )
