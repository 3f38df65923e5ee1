"""Processes that begin after the imports: `WarmPopen` is `subprocess.Popen`, but forks a Python that is ready.

Most of the time of a short command goes into imports. A zygote (`zygote.py`), one of each kind for a test process, has
done them before. Its child is a child of this process, with descriptors, environment, signals, session, exit code and
command line as those of a process that was started. What a zygote cannot stand for (another interpreter or option of
it, another PYTHONPATH, a folder with a module that hides one of the zygote's, ...) is started as ever; `warm` tells
which of both it was.

The zygotes import the modules of others, not ours: ours are imported in each process and keep nothing.
"""

import array
import atexit
import contextlib
import inspect
import os
import pickle
import platform
import resource
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

from gz_course.tests.process_guard import MARK

ZYGOTE = Path(__file__).with_name("zygote.py")
PROGRAMS = Path(sys.executable).parent
DEADLINE_S = 120.0
# What commands import. A module of ours that looks at the clock when it is imported, or that others look for in
# `sys.modules`, is not among them, nor what starts threads (rerun).
TRANSPORT = (
    "asyncio",
    "zmq",
    "gz_course.sim.gz.command_line",
    "gz_course.sim.gz.transport.commands.topic",
    "gz_course.sim.gz.transport.commands.service",
)
MESSAGES = (
    "geometry_msgs.msg",
    "rcl_interfaces.srv",
    "rosgraph_msgs.msg",
    "rosidl_generator_py",  # which rclpy imports for its first node
    "std_msgs.msg",
)
ROS = (
    *TRANSPORT,
    "rclpy.action",
    "rclpy.executors",
    *MESSAGES,
    "std_srvs.srv",
    "gz_course.sim.bridge.ros_gz_bridge.bridge",
    "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge",
    "gz_course.sim.bridge.ros_gz_sim.create",
    "gz_course.sim.ros.ros2.command_line",
    "gz_course.sim.ros.ros2.message_text",
    "gz_course.sim.ros.ros2.message_value",
    "gz_course.sim.ros.ros2.qos",
)
WITHOUT_ROS = (
    *TRANSPORT,
    *MESSAGES,
    "nav_msgs.msg",
    "sensor_msgs.msg",
    "pydantic.type_adapter",  # for typer
    "rich.console",
    "rich.table",
    "sqlite3",
    "gz_course.sim.gz.sim.commands.sim",
    "gz_course.sim.gz.sim.scene.graph",
    "gz_course.sim.gz.sim.sensors.camera",
    "gz_course.sim.gz.sim.sensors.lidar",
    "gz_course.sim.gz.sim.server",
    "gz_course.sim.gz.sim.systems.diff_drive",
    "gz_course.sim.gz.sim.systems.log_record",
    "gz_course.sim.gz.sim.systems.scene_broadcaster",
    "gz_course.sim.gz.sim.systems.user_commands",
    "gz_course.sim.gz.sim.world",
    "gz_course.grader.course",
    "gz_course.grader.grade",
    "gz_course.grader.run.session",
)
# Words in the name or the text of a program that is of ROS.
OF_ROS = ("rclpy", "ros2", "ros_gz", "parameter_bridge", "bridge_types", "robot_state_publisher")
# What Python and the C libraries read when they start.
AT_START = ("PYTHON", "LC_", "LD_", "MALLOC_", "GLIBC_", "OPENBLAS_", "OMP_", "SETUPTOOLS_")
ALSO_AT_START = {"LANG", "LANGUAGE", "TZ", "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
SET_IN_THE_CHILD = {"PYTHONUNBUFFERED", "PYTHONFAULTHANDLER"}
ENVIRONMENT = dict(os.environ)  # before a test changes it
PARAMETERS = tuple(inspect.signature(subprocess.Popen._execute_child).parameters)[1:]
# Options of `subprocess.Popen` with which a process is started as ever, unless they have these values.
ORDINARY = {"executable": None, "preexec_fn": None, "close_fds": True, "pass_fds": (), "shell": False,
            "restore_signals": True, "gid": None, "gids": None, "uid": None}  # fmt: skip


class Zygote:
    """The process that forks, and what a command must have in common with it."""

    def __init__(self, modules):
        self.owner = os.getpid()
        self.inherited = inherited()
        self._lock = threading.Lock()
        self._channel, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._channel.settimeout(DEADLINE_S)
        with far:
            self._process = subprocess.Popen(
                [sys.executable, "-P", str(ZYGOTE), str(far.fileno()), *modules],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=[far.fileno()],
                cwd="/",
                env=ENVIRONMENT | {"OPENBLAS_NUM_THREADS": "1", MARK: os.environ.get(MARK, "")},
            )
        atexit.register(self.close)
        answer = pickle.loads(self._channel.recv(1 << 20) or pickle.dumps({"error": "it has ended"}))
        self.error = answer.get("error")
        self.names = answer.get("names", set())  # of its modules
        self._asked = ALSO_AT_START | set(answer.get("asked", ()))
        self._environment = self._read_at_start({os.fsencode(n): os.fsencode(v) for n, v in ENVIRONMENT.items()})

    def _read_at_start(self, environment):
        """Return the variables that have been read before a child has its own."""
        names = {name: os.fsdecode(name) for name in environment}
        return {
            name: environment[name]
            for name, text in names.items()
            if (text.startswith(AT_START) or text in self._asked) and text not in SET_IN_THE_CHILD
        }

    def can_stand_for(self, command):
        return (
            not self.error
            and self.owner == os.getpid()
            and self._environment == self._read_at_start(command["environment"])
            and self.inherited == inherited()
            and not self.names & modules_in(command["folder"])
        )

    def fork(self, command, descriptors):
        """Return the number of a process that runs a command, None if the zygote has gone."""
        with self._lock:
            content = array.array("i", descriptors)
            try:
                self._channel.sendmsg([pickle.dumps(command)], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, content)])
            except OSError:  # it has gone, or the environment is very large
                return None
            answer = self._channel.recv(10_000).decode()
        if not answer.isdigit():
            raise subprocess.SubprocessError(f"a zygote could not make a process: {answer or 'it has ended'}")
        return int(answer)

    def close(self):
        if self.owner == os.getpid():
            self._channel.close()
            self._process.wait()


_zygotes = {}
_starting = threading.Lock()


def zygote_for(program):
    """Return the zygote for a program, a name or a text; start it if there is none yet."""
    is_ros = "gz_course.grader" not in program and any(word in program for word in OF_ROS)
    modules = ROS if is_ros else WITHOUT_ROS
    with _starting:
        if modules not in _zygotes:
            _zygotes[modules] = Zygote(modules)
        return _zygotes[modules]


def inherited():
    """Return what a process has from its parent and nobody hands over."""
    limits = [resource.getrlimit(getattr(resource, name)) for name in dir(resource) if name.startswith("RLIMIT_")]
    return limits, os.sched_getaffinity(0), os.getpriority(os.PRIO_PROCESS, 0)


def modules_in(folder):
    """Return the names that `import` would find in a folder; beside our programs lie only programs."""
    if folder is None or Path(folder) == PROGRAMS:
        return set()
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        return {each.name.partition(".")[0] for each in entries if each.name.endswith((".py", ".so")) or each.is_dir()}
    return set()


def understood(words, folder):
    """Return what a command runs as fields of a command for the zygote, None if it is not for a zygote."""
    program = Path(words[0])
    if program.parent != PROGRAMS:
        return None
    if words[0] == sys.executable:
        rest, executable, shown = words[1:], sys.executable, words
    else:
        executable = interpreter_of(program)
        rest, shown = list(words), [executable, *words]
    if executable is None:
        return None
    safe = rest[:1] == ["-P"]
    rest = rest[safe:]
    fields = {"title": program.name, "executable": executable, "shown": shown}
    if rest[:1] in (["-m"], ["-c"]) and len(rest) > 1:
        argv = [rest[0], *rest[2:]]
        path = str(folder) if rest[0] == "-m" else ""
        fields |= {"kind": rest[0], "what": rest[1], "argv": argv, "folder": folder}
    elif rest and not rest[0].startswith("-"):
        script = folder / rest[0]
        path = str(script.resolve().parent)
        if not script.is_file():
            return None
        fields |= {"kind": "script", "what": str(script), "argv": rest, "folder": path}
    else:
        return None
    return fields | ({"path": [], "folder": None} if safe else {"path": [path]})


def interpreter_of(program):
    """Return the Python of our environment that a script names in its first line."""
    with contextlib.suppress(OSError, UnicodeDecodeError), program.open() as file:
        name = Path(file.readline().removeprefix("#!").strip())
        if name.parent == PROGRAMS and name.resolve() == Path(sys.executable).resolve():
            return str(name)
    return None


class WarmPopen(subprocess.Popen):
    """A child process as `subprocess.Popen` makes it, without its imports where that makes no difference."""

    warm = False

    def _execute_child(self, *arguments):
        given = dict(zip(PARAMETERS, arguments, strict=True))
        pid = None
        if platform.machine() == "x86_64" and all(given[name] == value for name, value in ORDINARY.items()):
            pid = self._fork(given)
        if pid is None:
            super()._execute_child(*arguments)
            return
        self.warm, self.pid, self._child_created = True, pid, True
        pipes = ("p2cread", "p2cwrite", "c2pread", "c2pwrite", "errread", "errwrite")
        self._close_pipe_fds(*(given[name] for name in pipes))

    def _fork(self, given):
        words = given["args"]
        words = [os.fsdecode(each) for each in ([words] if isinstance(words, (str, bytes, os.PathLike)) else words)]
        folder = Path.cwd() / os.fsdecode(given["cwd"] or "")
        command = understood(words, folder)
        if command is None:
            return None
        environment = os.environ if given["env"] is None else given["env"]
        status = status_of_this_thread()
        command |= {
            "environment": {os.fsencode(name): os.fsencode(value) for name, value in environment.items()},
            "umask": int(status["Umask"], 8) if given["umask"] < 0 else given["umask"],
            "new_session": given["start_new_session"],
            "process_group": given.get("process_group", -1),
            "ignored": signals(status["SigIgn"]),
            "blocked": signals(status["SigBlk"]),
        }
        zygote = zygote_for(Path(command["what"]).name if command["kind"] == "script" else command["what"])
        if not zygote.can_stand_for(command):
            return None
        place = os.open(folder, os.O_PATH | os.O_DIRECTORY)
        streams = (given["p2cread"], given["c2pwrite"], given["errwrite"])
        try:
            return zygote.fork(command, [*(at if at != -1 else own for own, at in enumerate(streams)), place])
        finally:
            os.close(place)


def status_of_this_thread():
    return dict(line.split(":\t", 1) for line in Path("/proc/thread-self/status").read_text().splitlines())


def signals(mask):
    """Return the signals of a mask as /proc writes it."""
    bits = int(mask, 16)
    return {number for number in signal.valid_signals() if bits >> (number - 1) & 1}


def run(command, *, input=None, capture_output=False, timeout=None, check=False, **options):
    """Do what `subprocess.run` does."""
    if input is not None:
        options["stdin"] = subprocess.PIPE
    if capture_output:
        options |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with WarmPopen(command, **options) as process:
        try:
            stdout, stderr = process.communicate(input, timeout=timeout)
        except BaseException:
            process.kill()
            raise
        done = subprocess.CompletedProcess(process.args, process.returncode, stdout, stderr)
    if check:
        done.check_returncode()
    return done
