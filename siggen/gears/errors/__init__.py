"""Manufacturing errors of gears and teeth, by tolerance class."""
