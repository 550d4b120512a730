"""The same work for many keys, over processes or a cluster: it resumes, and repeats what a dead worker had begun."""

from pneumo_ros.sweep.executors import Pool, open_pool
from pneumo_ros.sweep.journal import Journal
from pneumo_ros.sweep.sweep import Done, sweep

__all__ = ["Done", "Journal", "Pool", "open_pool", "sweep"]
