"""Python message classes of ROS packages that are not installed, made by ROS's own generator.

Only the Python half is generated: the messages can be filled and converted, but not sent over DDS. The definitions list
the fields of the Jazzy packages.
"""

import contextlib
import io
import json
import sys
from pathlib import Path

DEFINITIONS = {
    "tf2_msgs": {"msg/TFMessage": "geometry_msgs/TransformStamped[] transforms"},
    "actuator_msgs": {
        "msg/Actuators": "std_msgs/Header header\nfloat64[] position\nfloat64[] velocity\nfloat64[] normalized"
    },
    "gps_msgs": {
        "msg/GPSStatus": """std_msgs/Header header
            uint16 satellites_used
            int32[] satellite_used_prn
            uint16 satellites_visible
            int32[] satellite_visible_prn
            int32[] satellite_visible_z
            int32[] satellite_visible_azimuth
            int32[] satellite_visible_snr
            int16 STATUS_NO_FIX=-1
            int16 STATUS_FIX=0
            int16 status
            uint16 motion_source
            uint16 orientation_source
            uint16 position_source""",
        "msg/GPSFix": """std_msgs/Header header
            GPSStatus status
            float64 latitude
            float64 longitude
            float64 altitude
            float64 track
            float64 speed
            float64 climb
            float64 pitch
            float64 roll
            float64 dip
            float64 time
            float64 gdop
            float64 pdop
            float64 hdop
            float64 vdop
            float64 tdop
            float64 err
            float64 err_horz
            float64 err_vert
            float64 err_track
            float64 err_speed
            float64 err_climb
            float64 err_time
            float64 err_pitch
            float64 err_roll
            float64 err_dip
            float64[9] position_covariance
            uint8 COVARIANCE_TYPE_UNKNOWN=0
            uint8 position_covariance_type""",
    },
    "marine_acoustic_msgs": {
        "msg/Dvl": """uint8 DVL_MODE_BOTTOM=1
            uint8 DVL_MODE_WATER=2
            uint8 DVL_TYPE_PISTON=0
            uint8 DVL_TYPE_PHASED_ARRAY=1
            std_msgs/Header header
            uint8 velocity_mode
            uint8 dvl_type
            geometry_msgs/Vector3 velocity
            float64[9] velocity_covar
            float64 altitude
            float64 course_gnd
            float64 speed_gnd
            uint8 num_good_beams
            float32 sound_speed
            bool beam_ranges_valid
            bool beam_velocities_valid
            geometry_msgs/Vector3[4] beam_unit_vec
            float64[4] range
            float32[4] range_covar
            float32[4] beam_quality
            float32[4] beam_velocity
            float32[4] beam_velocity_covar""",
    },
    "vision_msgs": {
        "msg/Point2D": "float64 x\nfloat64 y",
        "msg/Pose2D": "Point2D position\nfloat64 theta",
        "msg/BoundingBox2D": "Pose2D center\nfloat64 size_x\nfloat64 size_y",
        "msg/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
        "msg/ObjectHypothesis": "string class_id\nfloat64 score",
        "msg/ObjectHypothesisWithPose": "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
        "msg/Detection2D": "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox2D bbox\nstring id",
        "msg/Detection3D": "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id",
        "msg/Detection2DArray": "std_msgs/Header header\nDetection2D[] detections",
        "msg/Detection3DArray": "std_msgs/Header header\nDetection3D[] detections",
    },
    "ros_gz_interfaces": {
        "msg/Altimeter": """std_msgs/Header header
            float64 vertical_position
            float64 vertical_velocity
            float64 vertical_reference""",
        "msg/Entity": "uint64 id\nstring name\nuint8 type",
        "msg/JointWrench": """std_msgs/Header header
            std_msgs/String body_1_name
            std_msgs/UInt32 body_1_id
            std_msgs/String body_2_name
            std_msgs/UInt32 body_2_id
            geometry_msgs/Wrench body_1_wrench
            geometry_msgs/Wrench body_2_wrench""",
        "msg/Contact": """Entity collision1
            Entity collision2
            geometry_msgs/Vector3[] positions
            geometry_msgs/Vector3[] normals
            float64[] depths
            JointWrench[] wrenches""",
        "msg/Contacts": "std_msgs/Header header\nContact[] contacts",
        "msg/Dataframe": """std_msgs/Header header
            string src_address
            string dst_address
            uint8[] data
            float64 rssi""",
        "msg/EntityFactory": """string name
            bool allow_renaming false
            string sdf
            string sdf_filename
            string clone_name
            geometry_msgs/Pose pose
            string relative_to "world\"""",
        "msg/EntityWrench": "std_msgs/Header header\nEntity entity\ngeometry_msgs/Wrench wrench",
        "msg/Float32Array": "float32[] data",
        "msg/TrackVisual": """std_msgs/Header header
            string name
            uint32 id
            bool inherit_orientation
            float64 min_dist
            float64 max_dist
            bool is_static
            bool use_model_frame
            geometry_msgs/Vector3 xyz
            bool inherit_yaw""",
        "msg/GuiCamera": """std_msgs/Header header
            string name
            string view_controller
            geometry_msgs/Pose pose
            TrackVisual track
            string projection_type""",
        "msg/Light": """std_msgs/Header header
            string name
            uint8 type
            geometry_msgs/Pose pose
            std_msgs/ColorRGBA diffuse
            std_msgs/ColorRGBA specular
            float32 attenuation_constant
            float32 attenuation_linear
            float32 attenuation_quadratic
            geometry_msgs/Vector3 direction
            float32 range
            bool cast_shadows
            float32 spot_inner_angle
            float32 spot_outer_angle
            float32 spot_falloff
            uint32 id
            uint32 parent_id
            float32 intensity""",
        "msg/LogicalCameraImageModel": "string name\ngeometry_msgs/Pose pose",
        "msg/LogicalCameraImage": """std_msgs/Header header
            geometry_msgs/Pose pose
            LogicalCameraImageModel[] model""",
        "msg/MaterialColor": """std_msgs/Header header
            Entity entity
            std_msgs/ColorRGBA ambient
            std_msgs/ColorRGBA diffuse
            std_msgs/ColorRGBA specular
            std_msgs/ColorRGBA emissive
            float64 shininess
            uint8 entity_match""",
        "msg/ParamVec": "std_msgs/Header header\nrcl_interfaces/Parameter[] params",
        "msg/SensorNoise": """std_msgs/Header header
            uint8 type
            float64 mean
            float64 stddev
            float64 bias_mean
            float64 bias_stddev
            float64 precision
            float64 dynamic_bias_stddev
            float64 dynamic_bias_correlation_time""",
        "msg/StringVec": "std_msgs/Header header\nstring[] data",
        "msg/VideoRecord": """std_msgs/Header header
            bool start
            bool stop
            string format
            string save_filename""",
        "msg/WorldReset": "bool all\nbool time_only\nbool model_only",
        "msg/WorldControl": """bool pause
            bool step
            uint32 multi_step 0
            WorldReset reset
            uint32 seed
            builtin_interfaces/Time run_to_sim_time""",
        "srv/ControlWorld": "WorldControl world_control\n---\nbool success",
        "srv/SpawnEntity": "EntityFactory entity_factory\n---\nbool success",
        "srv/DeleteEntity": "Entity entity\n---\nbool success",
        "srv/SetEntityPose": "Entity entity\ngeometry_msgs/Pose pose\n---\nbool success",
    },
}


def generate(folder: Path) -> Path:
    """Write the packages below `folder`; return the folder for `sys.path`."""
    with contextlib.redirect_stdout(io.StringIO()):
        for package, interfaces in DEFINITIONS.items():
            _generate_package(folder, package, interfaces)
    return folder / "python"


def _generate_package(folder, package, interfaces):
    from rosidl_adapter.msg import convert_msg_to_idl
    from rosidl_adapter.srv import convert_srv_to_idl
    from rosidl_generator_py.generate_py_impl import generate_py

    source, made, out = folder / "source" / package, folder / "idl" / package, folder / "python" / package
    for name, text in interfaces.items():
        kind = name.split("/")[0]
        for place in (source / kind, made / kind, out / kind):
            place.mkdir(parents=True, exist_ok=True)
        lines = [_qualified(line.strip(), package, interfaces) for line in text.splitlines()]
        (source / f"{name}.{kind}").write_text("\n".join(lines) + "\n")
        convert = convert_msg_to_idl if kind == "msg" else convert_srv_to_idl
        convert(source, package, Path(f"{name}.{kind}"), made / kind)
    (out / "__init__.py").write_text("")
    arguments = folder / f"{package}.json"
    arguments.write_text(
        json.dumps(
            {
                "package_name": package,
                "idl_tuples": [f"{made}:{name}.idl" for name in interfaces],
                "output_dir": str(out),
                "template_dir": str(Path(sys.prefix) / "share" / "rosidl_generator_py" / "resource"),
                "target_dependencies": [],
            }
        )
    )
    generate_py(str(arguments), [])


def _qualified(line, package, interfaces):
    """Return a line in which the type of a field of the same package has the package name, as service files require."""
    kind = line.split(" ")[0].partition("[")[0]
    return f"{package}/{line}" if f"msg/{kind}" in interfaces else line
