"""Many machines over a long time: each campaign is examined by itself, then compared with the ones before."""
