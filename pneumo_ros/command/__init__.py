"""What the verbs of `pneumo` share: arguments, console, texts and JSON of results. No physics.

Whatever is slow to import or not always installed (numpy, numba, rosbags) is imported inside functions, so that help
and misspelt names are answered at once. `main.VERBS` names the verbs, which lie in `verb`.
"""
