"""Words of SDF 1.4 to 1.12: the children and attributes of every element, to report a typo with the nearest word.

As in Gazebo an unknown word is ignored with a warning. Words with a prefix (`gz:...`) and the contents of `<plugin>`
and `<gui>` are not checked. What stands in a `<sensor>` is said by the files of the sensors; here are those sensors
that are not simulated, and what many share. An element with several meanings (`<image>`, `<contact>`) has the words of
all of them.

Source: SDFormat specification, http://sdformat.org/spec
"""

from __future__ import annotations

import ast
import contextlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.element import Element

SENSORS = Path(__file__).parents[1] / "sensors"
_MOST_REPORTED = 100
_AXIS = "xyz initial_position use_parent_model_frame dynamics limit mimic"
_STATE = "name pose scale velocity acceleration wrench"
_METAL = (
    "albedo_map roughness_map metalness_map roughness metalness normal_map ambient_occlusion_map environment_map "
    "emissive_map light_map"
)
_NOISE = "type mean stddev bias_mean bias_stddev dynamic_bias_stddev dynamic_bias_correlation_time precision rate accel"
_EMITTER = (
    "emitting duration size particle_size lifetime rate min_velocity max_velocity scale_rate color_start color_end "
    "color_range_image topic particle_scatter_ratio pose material"
)
_ADDED_MASS = "xx xy xz xp xq xr yy yz yp yq yr zz zp zq zr pp pq pr qq qr rr"

_CHILDREN = {
    "sdf": "world model actor light include",
    "world": (
        "audio wind include gravity magnetic_field atmosphere gui physics scene light model actor road plugin "
        "joint frame state population spherical_coordinates"
    ),
    "model": (
        "static self_collide allow_auto_disable frame pose link joint model include gripper plugin enable_wind "
        "scale joint_state link_state model_state light"
    ),
    "include": "uri name static pose placement_frame plugin model_state",
    "actor": "static skin animation script link joint plugin pose frame",
    "skin": "filename scale",
    "animation": "filename scale interpolate_x",
    "script": "loop delay_start auto_start trajectory name uri",
    "trajectory": "waypoint",
    "waypoint": "time pose",
    "audio": "device",
    "wind": "linear_velocity",
    "atmosphere": "temperature temperature_gradient pressure",
    "spherical_coordinates": (
        "surface_model world_frame_orientation latitude_deg longitude_deg elevation heading_deg "
        "surface_axis_equatorial surface_axis_polar"
    ),
    "road": "width point material",
    "population": "model_count distribution box cylinder model pose frame",
    "distribution": "type rows cols step",
    "state": (
        "sim_time wall_time real_time iterations insertions deletions model light joint model_state light_state "
        "joint_state"
    ),
    "insertions": "model light joint",
    "deletions": "name",
    "model_state": f"joint_state link_state model_state joint link {_STATE}",
    "link_state": f"collision_state {_STATE}",
    "light_state": "pose frame",
    "joint_state": "axis_state axis2_state angle",
    "axis_state": "position velocity acceleration effort",
    "axis2_state": "position velocity acceleration effort",
    "link": (
        "pose gravity enable_wind self_collide kinematic must_be_base_link velocity_decay inertial collision "
        "visual sensor projector audio_sink audio_source battery light particle_emitter plugin frame velocity "
        "acceleration wrench"
    ),
    "velocity_decay": "linear angular",
    "inertial": "mass density auto_inertia_params pose inertia frame fluid_added_mass",
    "inertia": "ixx ixy ixz iyy iyz izz",
    "fluid_added_mass": _ADDED_MASS,
    "projector": "texture fov near_clip far_clip visibility_flags pose plugin frame",
    "audio_source": "uri pitch gain contact loop pose frame",
    "battery": "voltage",
    "particle_emitter": _EMITTER,
    "collision": "laser_retro max_contacts pose geometry surface density auto_inertia_params plugin frame",
    "visual": "cast_shadows laser_retro transparency visibility_flags pose material geometry plugin meta frame",
    "meta": "layer",
    "geometry": "box sphere cylinder capsule ellipsoid plane cone mesh heightmap polyline image empty",
    "box": "size",
    "sphere": "radius",
    "cylinder": "radius length",
    "cone": "radius length",
    "capsule": "radius length",
    "ellipsoid": "radii",
    "plane": "normal size",
    "mesh": "uri submesh scale convex_decomposition",
    "submesh": "name center",
    "convex_decomposition": "max_convex_hulls voxel_resolution",
    "heightmap": "uri size pos texture blend use_terrain_paging sampling",
    "texture": "size diffuse normal",
    "blend": "min_height fade_dist",
    "polyline": "point height",
    "image": "uri scale threshold granularity height",
    "material": ("script shader render_order lighting ambient diffuse specular shininess emissive double_sided pbr"),
    "shader": "normal_map",
    "pbr": "metal specular",
    "metal": _METAL,
    "specular": f"{_METAL} specular_map glossiness_map glossiness",
    "surface": "bounce friction contact soft_contact",
    "bounce": "restitution_coefficient threshold",
    "friction": "ode torsional bullet",
    "torsional": "coefficient use_patch_radius patch_radius surface_radius ode",
    "soft_contact": "dart",
    "ode": (
        "mu mu2 fdir1 slip1 slip2 slip soft_cfm soft_erp kp kd max_vel min_depth solver constraints cfm_damping "
        "implicit_spring_damper fudge_factor cfm erp bounce max_force velocity limit suspension provide_feedback"
    ),
    "bullet": (
        "friction friction2 fdir1 rolling_friction soft_cfm soft_erp kp kd split_impulse "
        "split_impulse_penetration_threshold solver constraints"
    ),
    "dart": ("bone_attachment stiffness damping flesh_mass_fraction collision_detector solver max_contacts"),
    "simbody": "min_step_size accuracy max_transient_velocity contact must_be_loop_joint",
    "solver": (
        "type min_step_size iters precon_iters sor use_dynamic_moi_rescaling friction_model island_threads "
        "thread_position_correction solver_type"
    ),
    "constraints": (
        "cfm erp contact_max_correcting_vel contact_surface_layer split_impulse split_impulse_penetration_threshold"
    ),
    "contact": (
        "collide_without_contact collide_without_contact_bitmask collide_bitmask category_bitmask "
        "poissons_ratio elastic_modulus ode bullet stiffness dissipation plastic_coef_restitution "
        "plastic_impact_velocity static_friction dynamic_friction viscous_friction "
        "override_impact_capture_velocity override_stiction_transition_velocity"
    ),
    "joint": (
        "parent child gearbox_ratio gearbox_reference_body thread_pitch screw_thread_pitch axis axis2 physics pose "
        "sensor frame plugin angle"
    ),
    "axis": _AXIS,
    "axis2": _AXIS,
    "mimic": "multiplier offset reference",
    "limit": "lower upper effort velocity stiffness dissipation cfm erp",
    "suspension": "cfm erp",
    "dynamics": "damping friction spring_reference spring_stiffness",
    "frame": "pose",
    "gripper": "grasp_check gripper_link palm_link",
    "grasp_check": "detach_steps attach_steps min_contact_count",
    "sensor": (
        "always_on update_rate visualize topic enable_metrics pose plugin frame frame_id gz_frame_id "
        "ignition_frame_id rfid rfidtag sonar transceiver"
    ),
    "noise": _NOISE,
    "rate": "mean stddev bias_mean bias_stddev",
    "accel": "mean stddev bias_mean bias_stddev",
    "x": "noise",
    "y": "noise",
    "z": "noise",
    "sonar": "geometry min max radius",
    "transceiver": "essid frequency min_frequency max_frequency gain power sensitivity",
    "light": ("cast_shadows diffuse specular attenuation direction spot pose intensity visualize light_on frame"),
    "attenuation": "range linear constant quadratic",
    "spot": "inner_angle outer_angle falloff",
    "physics": (
        "max_step_size real_time_factor real_time_update_rate max_contacts ode bullet simbody dart gravity "
        "magnetic_field provide_feedback"
    ),
    "scene": "ambient background sky shadows fog grid origin_visual shadow_caster_material_name",
    "sky": "time sunrise sunset clouds cubemap_uri",
    "clouds": "speed direction humidity mean_size ambient",
    "fog": "color type start end density",
}
"""Child elements by parent, without those that the files of sensors bring."""

_MOST_HOMES = 3
"""Maximum number of places named in a hint about a misplaced element."""

_RARE_HOMES = frozenset(("actor", "model_state", "link_state", "joint_state", "light_state", "collision_state"))
_CHILDREN_LISTING = "elements that can stand there are"

_NAMED = (
    "world model actor joint link collision visual sensor light frame camera battery projector road population gripper "
    "trajectory animation particle_emitter model_state link_state joint_state light_state collision_state"
)
_ATTRIBUTES = {
    **{element: "name" for element in _NAMED.split()},
    "sdf": "version",
    "world": "name namespace",
    "model": "name namespace canonical_link placement_frame",
    "include": "merge",
    "frame": "name attached_to",
    "joint": "name type",
    "sensor": "name type",
    "light": "name type",
    "particle_emitter": "name type",
    "physics": "name default type",
    "state": "world_name",
    "atmosphere": "type",
    "pose": "relative_to frame degrees rotation_format",
    "xyz": "expressed_in",
    "angle": "axis",
    "mimic": "joint axis",
    "inertial": "auto",
    "mesh": "optimization",
    "noise": "type",
    "normal_map": "type",
    "light_map": "uv_set",
    "shader": "type",
    "trajectory": "id type tension",
    "angular": "degrees",
    "position": "degrees",
    "actor": "name static",
    "plugin": "name filename",
}
_ANY_ATTRIBUTE = frozenset(("gui",))


class Words(NamedTuple):
    """The words of all elements; the children of parents that are not listed are not checked."""

    children: dict[str, frozenset[str]]
    attributes: dict[str, frozenset[str]]


@cache
def known_words() -> Words:
    """Return all words, with those of the sensors.

    The file of a sensor says in a literal dict `SDF_WORDS` what it brings: by element, its children and (`@name`) its
    attributes. It is read without importing the file, because the programs that only read SDF need no sensors. Raises
    ValueError for one that is no literal dict of texts.
    """
    words = {element: set(own.split()) for element, own in _CHILDREN.items()}
    for element, own in _ATTRIBUTES.items():
        words.setdefault(element, set()).update(f"@{name}" for name in own.split())
    for file in sorted(SENSORS.glob("*.py")):
        for element, brought in _words_of_sensor(file).items():
            words.setdefault(element, set()).update(brought.split())
    parts = {element: (own, {word for word in own if word.startswith("@")}) for element, own in words.items()}
    return Words(
        {element: frozenset(own - names) for element, (own, names) in parts.items() if own - names},
        {element: frozenset(name[1:] for name in names) for element, (_, names) in parts.items() if names},
    )


def _words_of_sensor(file: Path) -> dict[str, str]:
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and [getattr(each, "id", "") for each in node.targets] == ["SDF_WORDS"]:
            with contextlib.suppress(ValueError):
                words = ast.literal_eval(node.value)
                if isinstance(words, dict) and all(isinstance(word, str) for pair in words.items() for word in pair):
                    return words
            expected = "a literal dict of element -> words, such as {'sensor': 'sonar', 'sonar': 'min max'}"
            raise ValueError(f"{file}:{node.lineno}: SDF_WORDS is not {expected}")
    return {}


def described(element: str = "sdf", depth: int = 0, seen: set[str] | None = None) -> Iterator[str]:
    """Yield all words as the lines of a tree; an element that was there before is without what it holds."""
    words, seen = known_words(), set() if seen is None else seen
    indent, children = "  " * depth, sorted(words.children.get(element, ()))
    lines = [f"{indent}  <attribute name='{name}'/>" for name in sorted(words.attributes.get(element, ()))]
    if not (children or lines) or element in seen:
        yield f"{indent}<element name='{element}'/>"
        return
    seen.add(element)
    yield f"{indent}<element name='{element}'>"
    yield from lines
    for child in children:
        yield from described(child, depth + 1, seen)
    yield f"{indent}</element>"


def check(root: Element, diagnostics: Diagnostics) -> None:
    """Warn about each unknown element and attribute, with the nearest word."""
    for count, (where, sentence, word, known, listing) in enumerate(_unknown(root)):
        if count >= _MOST_REPORTED:
            diagnostics.warn(root.where, f"more than {_MOST_REPORTED} words are unknown to SDF, the rest is not named")
            return
        diagnostics.warn(where, f"{sentence}, it is ignored{_hint(word, known, listing)}")


def _hint(word: str, known: frozenset[str], listing: str) -> str:
    """Return the elements to which a word belongs, else the nearest known word."""
    every = known_words().children.items()
    homes = sorted(parent for parent, children in every if word in children and parent not in _RARE_HOMES)
    if listing == _CHILDREN_LISTING and 0 < len(homes) <= _MOST_HOMES:
        return f"; it belongs into {' or '.join(f'<{home}>' for home in homes)}"
    return did_you_mean(word, known, listing=listing)


def _unknown(root: Element) -> Iterator[tuple[str, str, str, frozenset[str], str]]:
    """Yield place, sentence, unknown word, words known there, and the phrase that lists them."""
    words = known_words()
    waiting = [root]
    while waiting:
        element = waiting.pop()
        known = words.children.get(element.tag)
        if element.attributes and element.tag not in _ANY_ATTRIBUTE:
            allowed = words.attributes.get(element.tag, frozenset())
            for name in element.attributes:
                if name not in allowed and ":" not in name and name != "xmlns":
                    sentence = f"<{element.tag}> has no attribute '{name}'"
                    yield element.where, sentence, name, allowed, "its attributes are"
        if known is None:
            continue
        below = []
        for child in element.children:
            if ":" in child.tag or child.tag in ("plugin", "gui"):
                continue
            if child.tag in known:
                below.append(child)
            else:
                sentence = f"<{element.tag}> has no element <{child.tag}>"
                yield child.where, sentence, child.tag, known, _CHILDREN_LISTING
        waiting.extend(reversed(below))
