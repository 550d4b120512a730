"""Random faults in real processes: the faults, the conditions that must still hold, and a table of both."""
