"""What the identification does: find complete recordings, identify in a process of its own, store results."""
