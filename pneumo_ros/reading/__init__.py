"""Recordings as runs, and whether they can be what they say: wiring, signs, units, dead sensors, idle parts."""
