"""`pneumo commission`: wiring, static and dynamic trials of a new axis, then the moves that narrow intervals most."""
