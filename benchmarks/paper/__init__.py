"""The paper of the axis reproduced on recordings of the second simulator: `python -m benchmarks.paper`."""
