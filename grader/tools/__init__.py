"""Programs beside grading: `course doctor`, `course diagnose`, the playground of the chapters, the book."""
