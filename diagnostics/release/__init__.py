"""What goes along with a saved classifier: facts, distance to the training, healthy-referenced variant, card."""
