"""The same work for many keys, over processes or a cluster: it resumes, and repeats the work of a worker that died."""

from pneumo_ros.sweep.executors import Pool, open_pool
from pneumo_ros.sweep.journal import Journal
from pneumo_ros.sweep.sweep import Done, sweep

__all__ = ["Done", "Journal", "Pool", "open_pool", "sweep"]
