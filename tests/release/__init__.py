"""What is released: pins with hashes, wheel, container file, workflows."""
