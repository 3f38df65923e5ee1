"""The table of `make verify`: each attack at each level of the sandbox, as root and as an ordinary user.

Every test of this folder (but of files with `NO_ATTACKS`) is a row and stands in the column of its `level` or `worker`.
A test that passes says `contained`, unless it has recorded another `verdict`; one that fails says `BREACH`. An attack
that did not take place fails its test. Behind the verdict stand the processes, files and pieces of shared memory that
were left.
"""

import os
from collections import defaultdict

LEVELS = ("A", "B", "C", "D")
USERS = ("root", "user")
NOTES = (
    "root at C and D, in what `cases/` holds: without capabilities in a container of its own (own processes, all",
    "read-only but /tmp), as in Docker; else the attacks would hit this machine.",
    "documented: this level does not hold that, and docs/instructors.md says so.",
    "-: this combination is not run; tests that need neither a level nor a user run as root at the best level.",
)


def place_of(item):
    """The row of a test, its level, and whether it is root."""
    params = dict(item.callspec.params) if hasattr(item, "callspec") else {}
    level, user = params.pop("worker", (params.pop("level", "A"), None))
    name = item.name.partition("[")[0].removeprefix("test_").replace("_", " ")
    if "case" in params:
        row = params["case"].replace("_", " ")
    else:
        parts = item.callspec.id.split("-") if params else []
        row = " ".join([name, *(part for part in parts if part not in (level, "ordinary", "user"))])
    return row, level, USERS[user is not None or os.getuid() != 0]


def rows_of(reports):
    """Verdicts by row and column: (row, level, user) -> text."""
    found = defaultdict(dict)
    for report in reports:
        told = dict(report.user_properties)
        if "attack" not in told or (report.when == "teardown" and report.passed):
            continue
        row, level, user = told["attack"]
        if report.failed:
            found[row][level, user] = "BREACH" + told.get("left", "")
        elif report.skipped:
            found[row].setdefault((level, user), "skipped")
        elif report.when == "call" and (level, user) not in found[row]:
            found[row][level, user] = told.get("verdict", "contained") + told.get("left", "")
    return found


def print_table(write, reports):
    """Write the table, if more than one column has been run."""
    found = rows_of(reports)
    columns = [(level, user) for level in LEVELS for user in USERS]
    columns = [column for column in columns if any(column in row for row in found.values())]
    if len(columns) < 2:
        return
    names = max(map(len, found))
    write("attacks: verdict, and processes/files/shared memory left")
    write(" ".join([" " * names, *(f"{level} {user:<14}" for level, user in columns)]).rstrip())
    for name in sorted(found):
        cells = [found[name].get(column, "-") for column in columns]
        write(" ".join([name.ljust(names), *(f"{cell:<16}" for cell in cells)]).rstrip())
    verdicts = [cell.split()[0] for row in found.values() for cell in row.values()]
    counted = ", ".join(f"{verdicts.count(word)} {word}" for word in ("contained", "documented", "BREACH", "skipped"))
    write(f"{len(found)} attacks: {counted}")
    for note in NOTES:
        write(note)
