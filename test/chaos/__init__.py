"""Faults at random, in real processes: what breaks, what must hold all the same, and a table of both."""
