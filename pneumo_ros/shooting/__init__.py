"""Multiple shooting: segments simulated from free starts, refits of parameters to them, and predictions in windows."""
