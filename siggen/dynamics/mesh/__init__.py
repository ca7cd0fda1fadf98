"""Force of the tooth pairs over position and approach."""
