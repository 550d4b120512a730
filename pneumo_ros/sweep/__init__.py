"""Much of the same work: over processes or a cluster, gone on with where it stopped, done again where a worker died."""

from pneumo_ros.sweep.executors import Pool, open_pool
from pneumo_ros.sweep.journal import Journal
from pneumo_ros.sweep.sweep import Done, sweep

__all__ = ["Done", "Journal", "Pool", "open_pool", "sweep"]
