"""The services of a running world, called through the bridge over DDS, with the classes made at run time."""

import math
import threading
import uuid

import pytest

from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
from gz_course.sim.bridge.ros_gz_bridge.config import read_yaml
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.scene_pb2 import Scene
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.sim.bridge.ros_gz_bridge.reading import parse_argument

DEADLINE = 120.0
GROUND = "<include><uri>model://ground_plane</uri></include>"
CUBE = "<sdf version='1.9'><model name='cube'><static>true</static><link name='l'/></model></sdf>"
KINDS = {"control": "ControlWorld", "create": "SpawnEntity", "set_pose": "SetEntityPose", "remove": "DeleteEntity"}
IN_A_FILE = """\
- service_name: /world/{world}/set_pose
  ros_type_name: ros_gz_interfaces/srv/SetEntityPose
  gz_req_type_name: gz.msgs.Pose
  gz_rep_type_name: gz.msgs.Boolean
"""


class Stage:
    """A world that runs in a thread, the bridge of its services, and a ROS client of each."""

    def __init__(self, ros):
        from ros_gz_interfaces import srv

        self.name = f"w{uuid.uuid4().hex}"
        self._ros, self._ros_node = ros, ros.new_node()
        self._gz = Node(NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS))
        self.world = World.from_string(f"<sdf version='1.9'><world name='{self.name}'>{GROUND}</world></sdf>")
        self.server = Server(self.world, self._gz)
        self.server.paused = True
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.server.run, kwargs={"real_time_factor": 0.0, "stop": self._stop})
        self._thread.start()
        written = read_yaml(IN_A_FILE.format(world=self.name), "b.yaml").services
        named = [
            parse_argument(f"/world/{self.name}/{service}@ros_gz_interfaces/srv/{kind}")
            for service, kind in KINDS.items()
            if service != "set_pose"
        ]
        self._bridge = Bridge(self._ros_node, self._gz, [], services=[*named, *written])
        self._clients = {
            service: ros.node.create_client(getattr(srv, kind), f"/world/{self.name}/{service}")
            for service, kind in KINDS.items()
        }

    def request(self, service):
        return self._clients[service].srv_type.Request()

    def call(self, service, request):
        client, answered = self._clients[service], threading.Event()
        assert client.wait_for_service(DEADLINE)
        future = client.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        assert answered.wait(DEADLINE)
        return future.result().success

    def scene(self):
        done, scene = self._gz.request(f"/world/{self.name}/scene/info", None, Empty, Scene, round(DEADLINE * 1000))
        assert done
        return {model.name: model for model in scene.model}

    def close(self):
        for client in self._clients.values():
            self._ros.node.destroy_client(client)
        self._bridge.close()
        self._stop.set()
        self._thread.join(DEADLINE)
        self.world.close()
        self._gz.close()
        self._ros.drop_node(self._ros_node)
        assert not self._thread.is_alive()


@pytest.fixture
def stage(ros):
    made = Stage(ros)
    yield made
    made.close()


def test_a_cube_is_spawned_moved_and_deleted_and_the_world_controlled(stage, capfd):
    create = stage.request("create")
    create.entity_factory.name, create.entity_factory.sdf = "box", CUBE
    create.entity_factory.pose.position.x = 2.0
    assert stage.call("create", create)
    assert stage.scene()["box"].pose.position.x == 2.0
    assert stage.call("create", create), "Gazebo answers before it finds out that the name is taken"
    create.entity_factory.allow_renaming = True
    assert stage.call("create", create)
    assert sorted(stage.scene()) == ["box", "box_0", "ground_plane"]

    move = stage.request("set_pose")
    move.entity.name, move.pose.position.y, move.pose.orientation.w = "box", 3.0, 1.0
    assert stage.call("set_pose", move)
    moved = stage.scene()["box"].pose.position
    assert (moved.x, moved.y) == (0.0, 3.0)

    control = stage.request("control")
    control.world_control.pause, control.world_control.multi_step = True, 5
    assert stage.call("control", control)
    while stage.world.iterations < 5:
        stage.scene()  # answered between two steps
    assert stage.world.iterations == 5
    control.world_control.multi_step, control.world_control.reset.all = 0, True
    assert stage.call("control", control)
    assert stage.scene() and stage.world.iterations == 0

    remove = stage.request("remove")
    remove.entity.name, remove.entity.type = "ground_plane", remove.entity.MODEL
    assert stage.call("remove", remove)
    assert "ground_plane" not in stage.scene()

    capfd.readouterr()
    assert not stage.call("create", stage.request("create"))
    create.entity_factory.pose.position.z = math.nan
    assert not stage.call("create", create)
    said = capfd.readouterr().err
    assert "there is nothing to spawn: none of sdf, sdf_filename, clone_name is given" in said
    assert "entity_factory.pose.position.z is nan" in said


@pytest.mark.proof
def test_the_same_with_the_programs_of_a_user(programs):
    programs.gz_sim(GROUND)
    services = [f"/world/small/{name}@ros_gz_interfaces/srv/{kind}" for name, kind in KINDS.items()]
    bridge = programs.ros2("run", "ros_gz_bridge", "parameter_bridge", *services)
    bridge.wait_for("ready: 4 bridges")
    programs.scene()  # the world is running

    def call(name, request):
        words = ["service", "call", f"/world/small/{name}", f"ros_gz_interfaces/srv/{KINDS[name]}", request]
        program = programs.ros2(*words)
        assert program.wait() == 0, program.said
        assert f"ros_gz_interfaces.srv.{KINDS[name]}_Response(success=True)" in program.said

    call("create", f'{{entity_factory: {{name: box, sdf: "{CUBE}", pose: {{position: {{x: 2.0}}}}}}}}')
    assert programs.scene()["box"].pose.position.x == 2.0
    call("set_pose", "{entity: {name: box}, pose: {position: {y: 3.0}, orientation: {w: 1.0}}}")
    call("control", "{world_control: {pause: true, multi_step: 5}}")
    assert programs.scene()["box"].pose.position.y == 3.0
    call("remove", "{entity: {name: box, type: 2}}")
    assert "box" not in programs.scene()
    assert bridge.stop() == 0
