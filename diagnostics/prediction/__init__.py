"""What saved models say about a recording, and whether it is like the records they were trained on."""
