"""The report of a set: figures, sentences and one self-contained page."""
