"""What a chapter asks of its reader: cells to write, predictions, questions that come back."""
