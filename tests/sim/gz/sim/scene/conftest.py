"""A world with every kind of entity in a scene."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from gz_course.sim.gz.sim.world import World

INSIDE = """
<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose><diffuse>0.8 0.7 0.6 1</diffuse>
  <specular>0.2 0.2 0.2 1</specular><direction>-0.5 0.1 -0.9</direction><cast_shadows>true</cast_shadows></light>
<scene><ambient>0.1 0.2 0.3 1</ambient><background>0.4 0.5 0.6 1</background><grid>false</grid>
  <sky><clouds><speed>12</speed></clouds></sky></scene>
<model name="floor"><static>true</static><pose>0 0 -1 0 0 0</pose><link name="slab">
  <collision name="touch"><geometry><plane><normal>0 0 1</normal><size>20 30</size></plane></geometry>
    <surface><friction><ode><mu>0.6</mu></ode></friction></surface></collision>
  <visual name="look"><geometry><plane><normal>0 0 1</normal><size>20 30</size></plane></geometry>
    <transparency>0.25</transparency><cast_shadows>false</cast_shadows>
    <material><diffuse>0.5 0.6 0.7 1</diffuse><ambient>0.1 0.1 0.1 1</ambient></material></visual></link></model>
<model name="robot"><pose>1 2 0.5 0 0 1.5707963267948966</pose>
  <link name="base"><inertial><mass>3</mass></inertial>
    <visual name="body"><pose>0 0 0.1 0 0 0</pose><geometry><box><size>1 2 3</size></box></geometry></visual>
    <visual name="head"><geometry><sphere><radius>0.5</radius></sphere></geometry></visual>
    <sensor name="eye" type="camera"><pose>0.3 0 0 0 0 0</pose><update_rate>10</update_rate>
      <camera><horizontal_fov>1.2</horizontal_fov><image><width>8</width><height>6</height></image></camera></sensor>
    <light name="lamp" type="spot"><pose>0.2 0 0 0 0 0</pose><diffuse>1 0 0 1</diffuse>
      <spot><inner_angle>0.1</inner_angle><outer_angle>0.5</outer_angle></spot></light></link>
  <link name="wheel"><pose>0 1 0 1.5707963267948966 0 0</pose>
    <visual name="tyre"><geometry><cylinder><radius>0.2</radius><length>0.1</length></cylinder></geometry></visual>
  </link>
  <joint name="axle" type="revolute"><parent>base</parent><child>wheel</child>
    <axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>2</upper></limit>
      <dynamics><damping>0.3</damping></dynamics></axis></joint>
  <model name="arm"><pose>0 0 1 0 0 0</pose>
    <link name="hand"><pose>0.5 0 0 0 0 0</pose>
      <visual name="palm"><geometry><capsule><radius>0.1</radius><length>0.4</length></capsule></geometry></visual>
    </link>
    <link name="finger"><pose>0.8 0 0 0 0 0</pose></link>
    <joint name="knuckle" type="revolute"><parent>hand</parent><child>finger</child>
      <axis><xyz>0 1 0</xyz></axis></joint>
  </model>
  <joint name="shoulder" type="fixed"><parent>base</parent><child>arm::hand</child></joint>
</model>
"""


@pytest.fixture
def world(load_text: Callable[..., World]) -> World:
    return load_text(f"<gravity>0 0 0</gravity>{INSIDE}")
