"""The grader's process, watched by Python's own audit events while it is given hostile worlds and models."""

import json
import subprocess
import sys

import pytest

SCRIPT = r"""
import base64, json, os, sys
from pathlib import Path
from gz_course.grader.kinds.launch.simulated_programs import SimulatedPrograms
from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.scene.message import scene_message
from gz_course.sim.gz.sim.sdf.assets import address
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

SECRET = sys.argv[1]
OWN = tuple(str(Path(place).resolve()) for place in (sys.prefix, sys.base_prefix, BUILT_IN_WORLDS.parents[3]))
PATHS = {"open", "os.listdir", "os.scandir", "os.mkdir", "os.remove", "os.rename", "os.rmdir", "os.truncate",
         "os.symlink", "os.link", "os.chmod", "glob.glob", "pathlib.Path.glob", "shutil.rmtree", "ctypes.dlopen"}
NEVER = {"subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.fork", "os.startfile", "socket.connect",
         "pickle.find_class", "os.putenv"}
armed, offences = False, []

def hook(event, arguments):
    if not armed:
        return
    if event in NEVER:
        offences.append((event, str(arguments)))
    elif event in PATHS and isinstance(arguments[0], (str, bytes, os.PathLike)):
        if not os.path.abspath(os.fsdecode(arguments[0])).startswith(OWN):
            offences.append((event, os.fsdecode(arguments[0])))
    elif event in ("exec", "compile"):
        code = arguments[0] if event == "exec" else None
        name = code.co_filename if code is not None else arguments[1]
        if not str(name).startswith(OWN):
            offences.append((event, str(name)))

sys.addaudithook(hook)

class Asking:
    gone, number = False, 0
    def tell(self, message):
        self.answer = message["answer"]

def world(inside, head=""):
    return f"{head}<sdf version='1.9'><world name='mine'>{inside}</world></sdf>"

def model(shape, more=""):
    return (f"<model name='m'><static>1</static><link name='l'><visual name='v'><geometry>{shape}</geometry>{more}"
            f"</visual><collision name='c'><geometry>{shape}</geometry></collision></link></model>")

BOX = "<box><size>1 1 1</size></box>"
URIS = (SECRET, f"file://{SECRET}", f"{SECRET}.xacro", "../" * 20 + SECRET, f"model://../../../../..{SECRET}",
        f"package://x/../../..{SECRET}", "asset:../" + SECRET)
WORLDS = [world(f"<include><uri >{uri}</uri ></include>") for uri in URIS]
WORLDS += [world(model(f"<mesh><uri>{uri}{end}</uri></mesh>")) for uri in URIS for end in ("", ".dae", ".obj")]
TERRAIN = "<heightmap><uri>{0}</uri><texture><diffuse>{0}</diffuse></texture></heightmap>"
WORLDS += [world(model(TERRAIN.format(uri))) for uri in URIS]
WORLDS += [
    world(model(BOX, f"<material><pbr><metal><albedo_map>{SECRET}</albedo_map><normal_map>{SECRET}</normal_map>"
                     f"</metal></pbr><script><uri>{SECRET}</uri><name>x</name></script></material>")),
    world(f"<plugin name='gz::sim::systems::LogRecord' filename='gz-sim-log-record-system'><record_path>{SECRET}-log"
          "</record_path><overwrite>true</overwrite><record_topic>(a+)+</record_topic></plugin>"),
    world(f"<plugin name='x' filename='{SECRET}'/><plugin name='os.system' filename='os.py'/>" + model(BOX)),
    world(model(BOX), f"<!DOCTYPE sdf [<!ENTITY x SYSTEM 'file://{SECRET}'>]>").replace("'mine'", "'&x;'"),
    world(model(BOX), f"<!DOCTYPE sdf SYSTEM 'file://{SECRET}'>"),
    world(model(BOX), f"<?xml-stylesheet href='file://{SECRET}'?>"),
    world("<model name='${__import__(1)}'><link name='l'/></model>"),
    world(f"<include><uri>crate</uri></include>{model(BOX)}").replace(
        "<sdf ", f"<sdf _files_='[&quot;{SECRET}&quot;, &quot;/etc/passwd&quot;]' _place_='0:1' "),
    f"<robot name='r'><link name='l'><visual><geometry><mesh filename='{SECRET}'/></geometry></visual></link></robot>",
    "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:include filename='" + SECRET + "'/></robot>",
]

def served(node, opened):
    return SimulatedPrograms(
        {"mine.sdf"}, Path("/submission"), 0, node, opened.append, lambda: None,
        entitled=lambda *_: True, arguments=lambda who: None,
    )

def load(each, text):
    name = address(text.encode(), "sdf")
    part = {"name": name, "size": len(text.encode()), "data": base64.b64encode(text.encode()).decode()}
    each.asked(Asking(), {"asset": part})
    asked = {"given": "w", "path": "/submission/mine.sdf", "built_in": "", "description": name, "error": ""}
    each.asked(Asking(), {"world": asked})

def create(each, **what):
    data = base64.b64encode(EntityFactory(**what).SerializeToString()).decode()
    each.asked(Asking(), {"call": {"verb": "create", "type": "gz.msgs.EntityFactory", "data": data}})

def simulate(text):
    opened = []
    with Node(NodeOptions(scope=Scope.PROCESS, partition="closed")) as node:
        each = served(node, opened)
        load(each, text)
        for now in opened:
            now.step(2)
            for uri in URIS[:3]:
                create(each, sdf_filename=uri, name="f")
                create(each, sdf=f"<sdf version='1.9'><include><uri >{uri}</uri ></include></sdf>")
                shape = model(f"<mesh><uri>{uri}</uri></mesh>").replace("'m'", "'n'")
                create(each, sdf=f"<sdf version='1.9'>{shape}</sdf>")
            now.requests.serve()
            now.step(2)
            scene_message(now)
            now.close()
    return len(opened)

systems()
simulate(world(model(BOX) + "<include><uri>x</uri></include>"))
simulate(WORLDS[-1])
armed = True
count = sum(map(simulate, WORLDS))
armed = False
print(json.dumps({"count": count, "worlds": len(WORLDS), "offences": offences}))
"""


# What a reader would do that is given the resources of the simulator's own files.
WITH_FILES = """
from gz_course.sim.gz.sim.sdf import assets, resources
for name in ("find_model", "find_file", "real", "stamp", "read_text", "read_mesh", "read_image"):
    setattr(assets.Assets, name, getattr(resources.Files, name))
"""


@pytest.fixture
def watched(tmp_path):
    """What the audit events told; `prepared` is code to be run first."""

    def call(prepared=""):
        text = "<sdf version='1.9'><model name='stolen'><static>1</static><link name='l'/></model></sdf>"
        for name in ("secret.sdf", "secret.sdf.xacro", "secret.sdf.dae", "secret.sdf.obj"):
            (tmp_path / name).write_text(text)
        command = [sys.executable, "-c", prepared + SCRIPT, str(tmp_path / "secret.sdf")]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[-3000:]
        return json.loads(done.stdout.splitlines()[-1])

    return call


def test_nothing_that_is_handed_over_opens_a_file_or_runs_code(watched, tmp_path):
    told = watched()
    assert told["offences"] == []
    assert told["count"] > told["worlds"] / 2, "most of them are worlds, with something left out"
    assert len(list(tmp_path.iterdir())) == 4


@pytest.mark.proof
def test_a_reader_that_opens_files_would_be_noticed(watched, tmp_path):
    offences = watched(WITH_FILES)["offences"]
    assert ["open", str(tmp_path / "secret.sdf")] in offences
    assert "subprocess.Popen" in {event for event, _ in offences}
