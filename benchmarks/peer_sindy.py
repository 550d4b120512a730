"""What PySINDy names: its weak form of the equations, and sparse regression of what the base model leaves.

The base model is fitted by the package first, and its parameters stay free within what is known of them: their part is
projected out of both sides. One regression takes all equations together, so that a term that acts in several of them
has one coefficient. Columns are scaled to a root mean square of one noise deviation. THRESHOLD and ALPHA were chosen
on machines of other seeds than those judged; see `docs/measurements.md`.
"""

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from peer_signals import Array
from peer_terms import TERMS
from peer_weak import weak_rows
from pysindy import STLSQ

from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.plant import Model

THRESHOLD = 1.0  # noise deviations: least rms share of a term in what the base model leaves
ALPHA = 1e-4  # ridge, per row


def named(model: Model, runs: Sequence[Any]) -> list[str]:
    """Effects of the terms that PySINDy keeps, the one with the largest share in the equations first."""
    fitter = Fitter(model, runs, candidates=())
    base = fitter.refit(model)
    known = fitter.known(base)
    rows = weak_rows(base, known, runs)
    return chosen(*projected(rows.left, rows.slopes, known.offset(base), rows.terms))


def projected(left: Array, slopes: Array, offset: Array, terms: Array) -> tuple[Array, Array]:
    """`left` and `terms` without what base parameters may take, whose priors are rows like others."""
    zeros = np.zeros((len(offset), terms.shape[1]))
    base = np.linalg.qr(np.concatenate([slopes, np.eye(len(offset))]))[0]
    left, terms = np.concatenate([left, offset]), np.concatenate([terms, zeros])
    return left - base @ (base.T @ left), terms - base @ (base.T @ terms)


def chosen(left: Array, terms: Array, threshold: float = THRESHOLD, alpha: float = ALPHA) -> list[str]:
    """Effects by `pysindy.STLSQ`."""
    size = np.sqrt(np.mean(terms**2, axis=0))
    size[size == 0.0] = 1.0  # of a term that these recordings never show
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it warns where it keeps no term
        found = STLSQ(threshold=threshold, alpha=alpha * len(left)).fit(terms / size, left[:, None])
    share = np.abs(found.coef_[0])
    return list(dict.fromkeys(TERMS[k].effect for k in np.argsort(-share) if share[k] > 0.0))
