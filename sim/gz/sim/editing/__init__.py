"""Editing of a running world: the `Editor`, and the commands of UserCommands, which call it."""
