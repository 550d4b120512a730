"""One verb, one file: a docstring whose first line `pneumo` lists, `add_arguments(parser)`, `run(options, console)`.

`run` returns the exit code. It imports what is slow inside.
"""
