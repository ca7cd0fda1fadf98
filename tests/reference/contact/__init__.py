"""Contact across the face beside independent solvers; `python -m tests.reference.contact` fits the notch again."""
