"""The whole worlds that get damaged: those that are built in, and one with every kind of element of SDF."""

from __future__ import annotations

import tempfile
from pathlib import Path

from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS, BUILT_IN_WORLDS
from gz_course.tests.sim.gz.sim.sdf.shapes_on_disk import write_heightmap, write_obj, write_stl

_FOLDER = tempfile.TemporaryDirectory(prefix="gz_sim_fuzz_")
_SHAPES = {
    "box": "<box><size>1 2 3</size></box>",
    "sphere": "<sphere><radius>0.5</radius></sphere>",
    "cylinder": "<cylinder><radius>0.5</radius><length>1</length></cylinder>",
    "capsule": "<capsule><radius>0.5</radius><length>1</length></capsule>",
    "ellipsoid": "<ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid>",
    "cone": "<cone><radius>0.5</radius><length>1</length></cone>",
    "mesh": "<mesh><uri>{folder}/ell.obj</uri><scale>1 1 1</scale><submesh><name>ell</name><center>true</center>"
    "</submesh></mesh>",
    "stl": "<mesh optimization='convex_hull'><uri>{folder}/wedge.stl</uri><scale>0.1 0.1 0.1</scale></mesh>",
    "polyline": "<polyline><point>0 0</point><point>1 0</point><point>1 1</point><point>0 1</point><height>0.4</height>"
    "</polyline><polyline><point>0.2 0.2</point><point>0.8 0.2</point><point>0.5 0.8</point><height>0.4</height>"
    "</polyline>",
}
_INERTIAL = (
    "<inertial><pose>0.1 0 0 0 0 0.2</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz>"
    "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>"
)
_AXIS = (
    "<axis><xyz expressed_in='__model__'>0 0 1</xyz><initial_position>0.1</initial_position><limit><lower>-1</lower>"
    "<upper>1</upper><effort>10</effort><velocity>2</velocity></limit><dynamics><damping>0.1</damping>"
    "<friction>0.1</friction><spring_stiffness>1</spring_stiffness><spring_reference>0.2</spring_reference></dynamics>"
    "</axis>"
)


def _shape_models() -> str:
    models = []
    for number, (name, shape) in enumerate(_SHAPES.items()):
        models.append(
            f"<model name='{name}'><pose degrees='true'>{3 * number} 0 2 0 10 0</pose><link name='link'>"
            f"<inertial auto='true'><density>500</density></inertial><collision name='c'><density>200</density>"
            f"<geometry>{shape}</geometry><surface><friction><ode><mu>0.5</mu><mu2>0.6</mu2><slip1>0.1</slip1>"
            "<fdir1>1 0 0</fdir1></ode></friction><contact><collide_bitmask>0x01</collide_bitmask></contact><bounce>"
            "<restitution_coefficient>0.5</restitution_coefficient></bounce></surface></collision>"
            f"<visual name='v'><geometry>{shape}</geometry><transparency>0.1</transparency><material><ambient>1 0 0 1"
            "</ambient><diffuse>0 1 0 1</diffuse></material></visual></link></model>"
        )
    return "".join(models)


def _joint_models() -> str:
    kinds = ("revolute", "continuous", "prismatic", "fixed", "ball", "universal", "revolute2", "screw")
    second = "<axis2><xyz>1 0 0</xyz></axis2>"
    models = []
    for number, kind in enumerate(kinds):
        models.append(
            f"<model name='j_{kind}'><pose>0 {5 + 3 * number} 3 0 0 0</pose><link name='base'>{_INERTIAL}</link>"
            f"<link name='arm'><pose relative_to='base'>0 0 0.5 0 0 0</pose>{_INERTIAL}<collision name='c'><geometry>"
            "<box><size>0.1 0.1 0.3</size></box></geometry></collision></link>"
            f"<joint name='hold' type='fixed'><parent>world</parent><child>base</child></joint>"
            f"<joint name='joint' type='{kind}'><pose relative_to='arm'>0 0 -0.2 0 0.1 0</pose><parent>base</parent>"
            f"<child>arm</child>{_AXIS}{second}<screw_thread_pitch>0.2</screw_thread_pitch>"
            f"<gearbox_ratio>2</gearbox_ratio></joint></model>"
        )
    return "".join(models)


_GEARS = f"""
<model name='gears' canonical_link='frame'><pose>-5 0 3 0 0 0</pose><self_collide>true</self_collide>
  <link name='frame'>{_INERTIAL}</link><link name='a'>{_INERTIAL}</link><link name='b'>{_INERTIAL}</link>
  <frame name='f' attached_to='frame'><pose>0 0 1 0 0 0</pose></frame>
  <joint name='ja' type='revolute'><parent>frame</parent><child>a</child><axis><xyz>0 0 1</xyz></axis></joint>
  <joint name='jb' type='revolute'><parent>frame</parent><child>b</child><axis><xyz>0 0 1</xyz>
    <mimic joint='ja' axis='axis'><multiplier>2</multiplier><offset>0.1</offset><reference>0</reference></mimic></axis>
  </joint>
  <joint name='gear' type='gearbox'><parent>a</parent><child>b</child><gearbox_ratio>2</gearbox_ratio>
    <gearbox_reference_body>frame</gearbox_reference_body><axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 0 1</xyz></axis2>
  </joint>
  <joint name='loop' type='ball'><parent>a</parent><child>frame</child></joint>
  <model name='inner' placement_frame='l'><pose relative_to='f'>0 0 1 0 0 0</pose><link name='l'>{_INERTIAL}
    <light name='lamp' type='spot'><spot><inner_angle>0.1</inner_angle><outer_angle>0.5</outer_angle>
    <falloff>0.8</falloff></spot></light></link>
    <model name='still'><static>true</static><link name='s'/></model></model>
  <joint name='to_inner' type='fixed'><parent>f</parent><child>inner::l</child></joint>
  <plugin filename='gz-sim-joint-state-publisher-system' name='gz::sim::systems::JointStatePublisher'/>
</model>
"""
_WORLD = """<sdf version='1.11'><world name='everything'>
<physics name='p' type='x'><max_step_size>0.002</max_step_size><real_time_factor>1</real_time_factor></physics>
<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>
<plugin filename='gz-sim-sensors-system' name='gz::sim::systems::Sensors'/>
<gravity>0 0 -9.8</gravity><magnetic_field>6e-6 2.3e-5 -4.2e-5</magnetic_field>
<scene><ambient>0.4 0.4 0.4 1</ambient><background>0.7 0.7 0.7 1</background></scene>
<light name='sun' type='directional'><pose relative_to='corner'>0 0 10 0 0 0</pose><direction>-0.5 0.1 -0.9</direction>
<attenuation><range>100</range><constant>1</constant><linear>0</linear><quadratic>0</quadratic></attenuation></light>
<frame name='corner'><pose>1 1 0 0 0 0</pose></frame>
<include><uri>model://ground_plane</uri></include>
<include merge='true'><uri>model://two_wheel_robot</uri><name>merged</name></include>
<include><uri>model://two_wheel_robot</uri><name>robot</name><pose>0 -5 0 0 0 0</pose></include>
<model name='terrain'><static>1</static><link name='l'><collision name='c'><geometry><heightmap>
<uri>{folder}/hill.png</uri><size>100 100 1</size><pos>0 0 -5</pos></heightmap></geometry></collision></link></model>
{models}
<joint name='between' type='revolute'><parent>box::link</parent><child>sphere</child><axis><xyz>1 0 0</xyz>
</axis></joint></world></sdf>"""


def _everything() -> str:
    folder = Path(_FOLDER.name)
    write_obj(folder / "ell.obj")
    write_stl(folder / "wedge.stl")
    write_heightmap(folder / "hill.png")
    text = _WORLD.replace("{models}", _shape_models() + _joint_models() + _GEARS)
    text = text.replace("<include merge='true'><uri>model://two_wheel_robot</uri><name>merged</name></include>", "")
    return text.replace("{folder}", _FOLDER.name)


def _with_robots() -> str:
    robots = "".join(
        (folder / "model.sdf").read_text().partition('<sdf version="1.10">')[2].rpartition("</sdf>")[0]
        for folder in sorted(BUILT_IN_MODELS.iterdir())
        if (folder / "model.sdf").is_file()
    )
    return f"<sdf version='1.10'><world name='robots'>{robots}</world></sdf>"


WORLDS = {
    "everything": _everything(),
    "robots": _with_robots(),
    **{path.name: path.read_text() for path in sorted(BUILT_IN_WORLDS.glob("*.sdf"))},
}
