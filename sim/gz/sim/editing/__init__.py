"""Changes of a running world: the `Editor`, and the commands of UserCommands that call it."""
