"""Which physical effect a model lacks: ranked, confirmed on recordings that were never fitted, and added."""
