"""One drawn gearbox in SI: the only place where configuration and physics meet."""
