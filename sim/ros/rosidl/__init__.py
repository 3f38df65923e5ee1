"""Type support for ROS interfaces made at run time from their texts, without a compiler.

`interface_text.py` reads a `.msg`, `.srv` or `.action` text; `interface_classes.py` makes its Python classes,
`type_description.py` its hash, and `message_type_support.py` what rcl and Fast DDS ask for. `import_hook.py` makes
`from PACKAGE.msg import Name` do all this for a package that is not compiled.
"""
