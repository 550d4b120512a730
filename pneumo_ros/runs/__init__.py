"""Runs: recordings on one even grid, with their noise, smoothed signals, cuts, and what sensors do to them."""
