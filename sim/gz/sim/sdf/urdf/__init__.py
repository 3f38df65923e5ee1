"""Reading URDF: `<robot>` (`robot`), xacro (`xacro_file`), fixed joints lumped (`lumping`), `<gazebo>` tags
(`gazebo_tags`), and the SDF model that all this means (`convert`).
"""
