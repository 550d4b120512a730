"""Runs: recordings on one even grid, with their noise, smoothed signals, cuts, and corrections for sensor effects."""
