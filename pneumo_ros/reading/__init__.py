"""Recordings as runs, and checks of them: wiring, signs, units, dead sensors, idle parts."""
