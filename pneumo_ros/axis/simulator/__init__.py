"""What the simulator does: valve input, plant and sensors, sample by sample."""
