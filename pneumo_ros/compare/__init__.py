"""`pneumo compare`: how much a model differs from measurements, in which equation and regime."""
