"""Prints the table of all scenes (`make fidelity`); with `--record` writes what DART and the plugin gave.

Words select scenes whose name contains one of them. The exit code is 1 if a row is wrong.
"""

from __future__ import annotations

import argparse
import json
import sys

from gz_course.sim.gz.sim.errors import LOG
from gz_course.tests.conformance.physics import dart, plugin
from gz_course.tests.conformance.physics.table import DIFFERS, ENGINES, REFERENCES, SAME, kinds, measure, recorded, rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*")
    parser.add_argument("--record", action="store_true", help="keep what DART and the plugin give now")
    parser.add_argument("--recorded", action="store_true", help="take DART and the plugin from the last recording")
    chosen = parser.parse_args()
    LOG.setLevel("ERROR")
    kept = recorded() if REFERENCES.is_file() else {}
    absent = {"dart": dart.why_absent(), "plugin": plugin.why_absent()}
    for text in filter(None, absent.values()):
        print(f"{text}; its column is what was recorded")
    wrong = 0
    print(f"{'scene':58} {'measure':32} {'ours':>10} {'DART':>10} {'plugin':>10} {'closed':>10}  verdict")
    for kind, scenes in kinds().items():
        print(kind)
        for scene in scenes:
            if chosen.words and not any(word in scene.name for word in chosen.words):
                continue
            given = dict(kept.get(scene.name, {}))
            if not chosen.recorded:
                for name in sorted(scene.engines):
                    if not absent[name]:
                        given[name] = measure(scene, ENGINES[name])
            for row in rows(scene, given):
                numbers = (row.ours, row.dart, row.plugin, row.measure.closed)
                shown = " ".join(f"{'-':>10}" if each is None else f"{each:10.4f}" for each in numbers)
                print(f"  {scene.name:56} {row.measure.name:32} {shown}  {row.verdict}", flush=True)
                wrong += row.verdict not in (SAME, DIFFERS)
            kept[scene.name] = {name: [float(f"{value:.6g}") for value in values] for name, values in given.items()}
    if chosen.record:
        names = {scene.name for scenes in kinds().values() for scene in scenes}
        lines = (f"  {json.dumps(name)}: {json.dumps(kept[name])}" for name in sorted(names & kept.keys()))
        REFERENCES.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    print(f"{wrong} rows are wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
