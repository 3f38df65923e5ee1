"""Load one world as `gz sim` does, step it, and print what happened: `python -m gz_course.tests.worlds.one_world FILE`.

The last line of the output is JSON: `kind` and `said`.
"""

from __future__ import annotations

import json
import logging
import resource
import sys
from pathlib import Path

STEPS = 100
PROCESSOR_S = 120
MEMORY = 6 << 30  # [bytes] of address space


def main(path: Path) -> None:
    from gz_course.sim.gz.sim.errors import SimError
    from gz_course.sim.gz.sim.world import World

    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR_S, PROCESSOR_S))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    logging.getLogger("gz.sim").setLevel(logging.CRITICAL)
    try:
        world = World.load(path, lenient=True)
        world.step(STEPS)
    except SimError as error:
        print(json.dumps({"kind": "refused", "said": [str(error)]}))
        return
    said = list(world.warnings)
    world.close()
    print(json.dumps({"kind": "warns" if said else "loads", "said": said}))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
