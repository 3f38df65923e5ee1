"""Reader of SDF: XML (`element`), known words (`vocabulary`), files (`resources`), frames, description of a world."""
