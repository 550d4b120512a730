"""`pneumo diagnose` and `pneumo add`: the physical effects that a model lacks, ranked, confirmed and added."""
