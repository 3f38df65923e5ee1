"""The words of SDF: which elements may stand inside which, so that a typo is answered with the word that was
meant.

Used by the reader right after parsing. An unknown element never stops a world (Gazebo ignores it silently);
it gets one warning line. Elements with a prefix (`gz:...`), and everything inside `<plugin>` and `<gui>`,
belong to others and pass.
"""

from __future__ import annotations

from collections.abc import Iterator

from gz.sim.errors import Diagnostics, nearest
from gz.sim.sdf.element import Element

_NOISE = "type mean stddev bias_mean bias_stddev dynamic_bias_stddev dynamic_bias_correlation_time precision"
_GEOMETRY = "box sphere cylinder capsule ellipsoid plane cone mesh heightmap polyline image empty"
_AXIS = "xyz initial_position use_parent_model_frame dynamics limit mimic"
_CAMERA = (
    "triggered trigger_topic camera_info_topic horizontal_fov image clip save depth_camera "
    "segmentation_type box_type "
    "noise distortion lens visibility_mask optical_frame_id pose background"
)
_RAY = "scan range noise visibility_mask vertical horizontal"

CHILDREN: dict[str, frozenset[str]] = {
    parent: frozenset(words.split())
    for parent, words in {
        "sdf": "world model actor light",
        "world": (
            "audio wind include gravity magnetic_field atmosphere gui physics scene light model actor "
            "road plugin joint "
            "frame state population spherical_coordinates"
        ),
        "model": (
            "static self_collide allow_auto_disable frame pose link joint model include gripper plugin enable_wind"
        ),
        "include": "uri name static pose placement_frame plugin merge",
        "link": (
            "pose gravity enable_wind self_collide kinematic must_be_base_link velocity_decay inertial "
            "collision visual "
            "sensor projector audio_sink audio_source battery light particle_emitter plugin frame"
        ),
        "inertial": "mass density auto_inertia_params pose inertia frame fluid_added_mass",
        "inertia": "ixx ixy ixz iyy iyz izz",
        "collision": ("laser_retro max_contacts pose geometry surface density auto_inertia_params plugin frame"),
        "visual": ("cast_shadows laser_retro transparency visibility_flags pose material geometry plugin meta frame"),
        "geometry": _GEOMETRY,
        "box": "size",
        "sphere": "radius",
        "cylinder": "radius length",
        "cone": "radius length",
        "capsule": "radius length",
        "ellipsoid": "radii",
        "plane": "normal size",
        "mesh": "uri submesh scale convex_decomposition",
        "material": (
            "script shader render_order lighting ambient diffuse specular shininess emissive double_sided pbr"
        ),
        "surface": "bounce friction contact soft_contact",
        "friction": "ode torsional bullet mu",
        "joint": (
            "parent child gearbox_ratio gearbox_reference_body thread_pitch "
            "screw_thread_pitch axis axis2 physics pose sensor frame plugin"
        ),
        "axis": _AXIS,
        "axis2": _AXIS,
        "limit": "lower upper effort velocity stiffness dissipation cfm erp",
        "dynamics": "damping friction spring_reference spring_stiffness cfm_damping implicit_spring_damper",
        "frame": "pose",
        "sensor": (
            "always_on update_rate visualize topic enable_metrics pose plugin frame frame_id gz_frame_id "
            "ignition_frame_id air_pressure air_speed altimeter camera contact force_torque gps navsat "
            "imu lidar ray "
            "logical_camera magnetometer rfid rfidtag sonar transceiver"
        ),
        "lidar": _RAY,
        "ray": _RAY,
        "scan": "horizontal vertical",
        "horizontal": "samples resolution min_angle max_angle",
        "vertical": "samples resolution min_angle max_angle",
        "range": "min max resolution",
        "noise": _NOISE,
        "camera": _CAMERA,
        "image": "width height format anti_aliasing",
        "clip": "near far",
        "imu": ("angular_velocity linear_acceleration orientation_reference_frame enable_orientation noise topic"),
        "light": ("cast_shadows diffuse specular attenuation direction spot pose intensity visualize light_on frame"),
        "physics": ("max_step_size real_time_factor real_time_update_rate max_contacts ode bullet simbody dart"),
        "scene": "ambient background sky shadows fog grid origin_visual shadow_caster_material_name",
    }.items()
}


def check(root: Element, diagnostics: Diagnostics) -> None:
    """Warn about each element of the tree that SDF does not know at its place, with the nearest word."""
    for element, child in _unknown(root):
        hint = nearest(child.tag, CHILDREN[element.tag], listing="elements that can stand there are")
        diagnostics.warn(child.where, f"<{element.tag}> has no element <{child.tag}>, it is ignored; {hint}")


def _unknown(element: Element) -> Iterator[tuple[Element, Element]]:
    known = CHILDREN.get(element.tag)
    for child in element.children:
        if ":" in child.tag or child.tag in ("plugin", "gui"):
            continue
        if known is not None and child.tag not in known:
            yield element, child
        elif known is not None:
            yield from _unknown(child)
