"""From recordings to numbers: noise, velocities, starting states, prediction windows and residuals of the equations."""
