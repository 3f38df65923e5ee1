"""Control of the grader's own processes: how they end on signals, their temporary folders, the locks they hold."""
