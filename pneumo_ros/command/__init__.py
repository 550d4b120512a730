"""`pneumo`: one verb, one file: arguments, one call, output; no physics.

A verb is a module with a one-line docstring (what `pneumo` lists), `add_arguments(parser)` and
`run(options, console) -> exit code`. Whatever is slow to import or not always installed (numpy, numba, rosbags) it
imports inside `run`, so that help and misspelt names are answered at once. `main.VERBS` names it.
"""
