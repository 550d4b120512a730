"""Many machines over a long time: each campaign examined by itself, then what changed from one to the next."""
