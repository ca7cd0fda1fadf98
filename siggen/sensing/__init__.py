"""From what the model gives to what a data logger stores."""
