"""An independent second simulator of the servo-pneumatic axis.

It shares no code with the package and states the equations in other variables, so that an error in one is not an error
in both. `oracle` answers to many digits through scipy's stiff solvers and judges the package's plant; `case` makes
recordings of a machine with a hidden effect, on which the diagnosis is judged.
"""
