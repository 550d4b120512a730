"""Where a model fails against measurements, and why."""
