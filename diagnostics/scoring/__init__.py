"""Predictions of any detector or classifier, judged on the records of a set beside those of its trainings."""
