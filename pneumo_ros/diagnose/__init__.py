"""What `pneumo diagnose` and `pneumo add` run: which physical effect a model lacks, ranked, confirmed and added."""
