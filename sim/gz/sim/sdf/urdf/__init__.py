"""Reader of URDF: `robot` reads `<robot>`, `xacro_file` expands xacro, `lumping` lumps fixed joints, `gazebo_tags`
reads `<gazebo>`, `convert` makes the SDF model.
"""
