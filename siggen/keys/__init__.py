"""What a key of the YAML file may hold: numbers, distributions, words, teeth and places, with their messages."""
