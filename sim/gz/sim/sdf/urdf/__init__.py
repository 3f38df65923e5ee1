"""Reader of URDF: `<robot>` (`robot`), xacro (`xacro_file`), lumping of fixed joints (`lumping`), `<gazebo>` tags
(`gazebo_tags`), and the conversion to an SDF model (`convert`).
"""
