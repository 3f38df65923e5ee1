"""Exercise manifests: what is read, and that every mistake is told with the file and the key."""

import hashlib
import shutil

import pytest

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import course_root, exercise_names, find_exercise, load_exercise

GOOD = """\
file = "node.py"

[run]
world = "empty.sdf"
robot = "robot"
bridge = "bridge.yaml"
duration = 8.0
tick = 0.02
observe = { "/answer" = "std_msgs/msg/Float32" }

[[script]]
at = 1.0
topic = "/model/robot/cmd_vel"
linear_x = 0.3
angular_z = 0.1

[[check]]
id = "one"
title = "Does one thing"
points = 60
kind = "change"
signal = "truth/robot/x"
band = [0.5, 1.0]
hint = "Do it."

[[check]]
id = "two"
title = "Does another"
points = 40
kind = "change"
signal = "truth/robot/y"
band = [0.5, 1.0]
hint = "Do that."
"""

TASK = """\
# A title

What to do.

- First this.

    then that

## Points

None.
"""


@pytest.fixture
def folder(tmp_path):
    """Write a manifest and its task into `exercises/01_made` and return that folder."""

    def write(text=GOOD, name="01_made", task=TASK):
        path = tmp_path / "exercises" / name
        (path / "grading").mkdir(parents=True, exist_ok=True)
        (path / "README.md").write_text(task)
        (path / "grading/exercise.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


def test_a_manifest_is_read(folder):
    exercise = load_exercise(folder())
    assert (exercise.name, exercise.title, exercise.file) == ("01_made", "A title", "node.py")
    assert exercise.summary == "What to do.\n\n- First this.\n\n    then that"
    assert (exercise.duration, exercise.tick, exercise.max_score) == (8.0, 0.02, 100)
    assert exercise.starter == exercise.folder / "node.py"
    assert exercise.bridge == exercise.folder / "bridge.yaml"
    assert exercise.observe == {"/answer": "std_msgs/msg/Float32"}
    assert (exercise.script[0].at, exercise.script[0].linear_x) == (1.0, 0.3)
    assert [check.id for check in exercise.checks] == ["one", "two"]
    assert exercise.checks[0].parameters == {"signal": "truth/robot/x", "band": [0.5, 1.0]}


def test_a_world_beside_the_manifest_and_parameters_of_the_bridge(folder):
    given = 'bridge_parameters = { "qos_overrides./tf_static.publisher.durability" = "transient_local" }'
    path = folder(GOOD.replace("tick = 0.02", given))
    (path / "empty.sdf").write_text("<sdf/>")
    exercise = load_exercise(path)
    assert exercise.world == str(path / "empty.sdf")
    assert exercise.bridge_parameters == {"qos_overrides./tf_static.publisher.durability": "transient_local"}


def test_optional_keys_have_defaults(folder):
    lines = [line for line in GOOD.splitlines() if not line.startswith(("tick", "observe"))]
    exercise = load_exercise(folder("\n".join(lines)))
    assert (exercise.tick, exercise.observe) == (0.01, {})


def without(key):
    lines = GOOD.splitlines()
    del lines[next(i for i, line in enumerate(lines) if line.startswith(f"{key} ="))]
    return "\n".join(lines)


@pytest.mark.parametrize("key", ["file", "world", "robot", "bridge", "duration"])
def test_a_missing_key_is_named_with_the_file(folder, key):
    with pytest.raises(ManifestError, match=rf"01_made/grading/exercise\.toml.*'{key}'"):
        load_exercise(folder(without(key)))


@pytest.mark.parametrize("key", ["id", "points", "kind", "hint"])
def test_a_key_missing_in_a_check_is_named_with_the_check(folder, key):
    with pytest.raises(ManifestError, match=rf"exercise\.toml.*check.*'{key}'"):
        load_exercise(folder(without(key)))


def test_no_checks_at_all(folder):
    with pytest.raises(ManifestError, match=r"exercise\.toml.*'check'"):
        load_exercise(folder(GOOD.split("[[check]]")[0]))


def test_no_run_table(folder):
    text = GOOD.split("[run]")[0] + "[[check]]" + GOOD.split("[[check]]")[1]
    with pytest.raises(ManifestError, match=r"exercise\.toml.*'run'"):
        load_exercise(folder(text))


def test_a_check_id_used_twice(folder):
    with pytest.raises(ManifestError, match=r"exercise\.toml.*'one'.*twice"):
        load_exercise(folder(GOOD.replace('id = "two"', 'id = "one"')))


@pytest.mark.parametrize("text", ["file = ", b"file = '\xff\xfe'", "= 3", "[run", "a = 1\na = 2"])
def test_what_is_not_toml(folder, text):
    with pytest.raises(ManifestError, match=r"01_made/grading/exercise\.toml: "):
        load_exercise(folder(text))


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("duration = 8.0", 'duration = "long"', "duration"),
        ("duration = 8.0", "duration = 0", "duration"),
        ("duration = 8.0", "duration = -1.0", "duration"),
        ("duration = 8.0", "duration = nan", "duration"),
        ("duration = 8.0", "duration = inf", "duration"),
        ("tick = 0.02", "tick = 0.0", "tick"),
        ("tick = 0.02", "tick = -0.01", "tick"),
        ("tick = 0.02", 'tick = "fast"', "tick"),
        ('world = "empty.sdf"', "world = 3", "world"),
        ('file = "node.py"', "file = 3", "file"),
        ('file = "node.py"', 'file = "../elsewhere/node.py"', "file"),
        ('file = "node.py"', 'file = "node.py"\nfiles = ["../robot.sdf"]', "files"),
        ('file = "node.py"', 'file = "node.py"\nfiles = ["node.py"]', "files"),
        ('observe = { "/answer" = "std_msgs/msg/Float32" }', "observe = 3", "observe"),
        ('observe = { "/answer" = "std_msgs/msg/Float32" }', 'observe = { "/answer" = 3 }', "observe"),
        ("points = 60", 'points = "many"', "points"),
        ("points = 60", "points = -60", "points"),
        ("at = 1.0", 'at = "soon"', "at"),
        ("linear_x = 0.3", "linear = 0.3", "linear"),
        ('kind = "change"', "kind = 3", "kind"),
        ("tick = 0.02", "tikc = 0.02", "tikc.*tick"),
        ("tick = 0.02", 'extra = "what is this"', "extra"),
    ],
)
def test_a_wrong_value_or_key_is_told_with_file_and_key(folder, old, new, key):
    assert old in GOOD
    with pytest.raises(ManifestError, match=rf"exercise\.toml.*{key}"):
        load_exercise(folder(GOOD.replace(old, new, 1)))


def test_a_check_that_is_no_table(folder):
    text = GOOD.split("[[check]]")[0]
    with pytest.raises(ManifestError, match=r"exercise\.toml.*check"):
        load_exercise(folder('check = ["one"]\n' + text))


def test_exercises_exist_by_being_there(folder, tmp_path):
    folder(name="02_second")
    folder(name="01_first")
    (tmp_path / "exercises" / "03_no_manifest").mkdir()
    assert exercise_names(tmp_path) == ["01_first", "02_second"]


def test_an_exercise_is_found_by_name_and_by_its_beginning(folder, tmp_path):
    for name in ("01_one", "01_one_more", "02_two"):
        folder(name=name)
    assert find_exercise("02", tmp_path).name == "02_two"
    assert find_exercise("02_two", tmp_path).name == "02_two"
    assert find_exercise("2", tmp_path).name == "02_two"
    assert find_exercise("01_one", tmp_path).name == "01_one", "a whole name is no ambiguous beginning"


def test_a_name_nobody_has_is_answered_with_the_nearest(folder, tmp_path):
    folder(name="03_teleop")
    folder(name="04_lidar_listener")
    with pytest.raises(UsageError, match=r"'03_telepo'.*did you mean '03_teleop'\?"):
        find_exercise("03_telepo", tmp_path)
    with pytest.raises(UsageError, match="no exercise is called ''"):
        find_exercise("", tmp_path)


@pytest.mark.parametrize("path", ["exercises/03_teleop", "exercises/03_teleop/teleop_node.py", "/a/03_teleop/"])
def test_a_path_is_no_name(folder, tmp_path, path):
    folder(name="03_teleop")
    with pytest.raises(UsageError, match=r"is a path.*--submission; did you mean '03_teleop'\?"):
        find_exercise(path, tmp_path)


def test_an_ambiguous_beginning_is_refused(folder, tmp_path):
    folder(name="03_one")
    folder(name="03_two")
    with pytest.raises(UsageError, match=r"several exercises begin with '03'.*03_(one|two)"):
        find_exercise("03", tmp_path)


def test_the_course_is_looked_for_upwards(folder, tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_ROOT", raising=False)
    deep = folder() / "deep" / "er"
    deep.mkdir(parents=True)
    monkeypatch.chdir(deep)
    assert course_root() == tmp_path


def test_the_environment_names_the_course(folder, tmp_path, monkeypatch):
    monkeypatch.setenv("COURSE_ROOT", str(tmp_path / "else where"))
    folder()
    monkeypatch.chdir(tmp_path)
    assert course_root() == tmp_path / "else where"


def test_without_a_course_around_it_is_the_one_of_the_grader(tmp_path, monkeypatch, root):
    monkeypatch.delenv("COURSE_ROOT", raising=False)
    monkeypatch.chdir(tmp_path)
    assert course_root() == root


@pytest.mark.parametrize("name", ["03_teleop", "04_lidar_listener"])
def test_the_shipped_exercises_load_and_give_a_hundred_points(name, root, tmp_path):
    exercise = find_exercise(name, root)
    assert exercise.max_score == 100
    assert exercise.starter.is_file() and exercise.bridge.is_file()
    shutil.copytree(exercise.folder, tmp_path / name)
    assert load_exercise(tmp_path / name).checks == exercise.checks, "a manifest does not depend on where it lies"


def test_an_unknown_kind_of_submission_is_told_with_the_nearest(folder):
    with pytest.raises(ManifestError, match=r"kind is 'nod'; (known|did you mean).*node"):
        load_exercise(folder('kind = "nod"\n' + GOOD))


def test_the_hash_of_a_manifest_is_also_over_its_functions(folder):
    plain = load_exercise(folder()).manifest_sha256
    assert plain == hashlib.sha256(GOOD.encode()).hexdigest()
    path = folder(GOOD.replace('kind = "change"', 'kind = "python"\nfunction = "checks.py:one"', 1))
    hashes = []
    for text in ("def one(): pass", "def one(): return 1"):
        (path / "grading/checks.py").write_text(text)
        hashes.append(load_exercise(path).manifest_sha256)
    assert len({plain, *hashes}) == 3


@pytest.mark.parametrize(
    "task", ["", "A title\n\nWhat to do.\n", "# A title\n", "# \n\nWhat\n", "# A title\n\n## Points\n"]
)
def test_a_task_without_title_or_words_is_told_with_its_file(folder, task):
    with pytest.raises(ManifestError, match=r"01_made/README\.md must begin with `# TITLE`"):
        load_exercise(folder(task=task))


def test_a_task_that_is_not_there_is_told(folder):
    path = folder()
    (path / "README.md").unlink()
    with pytest.raises(ManifestError, match=r"01_made/README\.md cannot be read"):
        load_exercise(path)
