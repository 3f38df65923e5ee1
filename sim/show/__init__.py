"""Programs that show what goes on, and one to drive with: RViz, rqt_graph, teleop_twist_keyboard."""
