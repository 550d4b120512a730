"""An independent second simulator of the servo-pneumatic axis.

It shares no code with the package and states the equations in other variables, so that an error in one is not an error
in both. `oracle` answers to many digits through scipy's stiff solvers and judges the package's plant. The rest makes
recordings of a machine with a hidden effect, to judge the diagnosis: `machine` is the recorded machine, `effects`
its hidden effects, `excitation` its runs, `loop` integrates, `sensors` add errors, `case` and `bags` write.

From a checkout, `python test/rig --out DIR --effect random --seed 1` does all that; `--help` lists the rest.
"""
