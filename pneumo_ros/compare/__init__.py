"""What `pneumo compare` runs: by how much a model differs from measurements, in which equation and regime."""
