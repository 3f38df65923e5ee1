"""The `ros2` command, for machines without a ROS 2 installation; where there is one, that one answers.

Contents: `command_line` (finds the command and hands over to it), `command` (one file a command, one folder a
command with verbs, one file a verb), and what they share: `packages`, `child`, `graph`, `interface`,
`message_text`, `topic`, `errors`, `hand_over`.
"""
