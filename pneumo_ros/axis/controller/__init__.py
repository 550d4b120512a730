"""What the controller does: references in, voltages out, and when the valve is closed."""
