"""What a node reports about itself: numbers, warnings and errors."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass
class Health:
    """What a node reports: numbers by name (units in the names), warnings and errors as sentences."""

    values: Mapping[str, object] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    @property
    def message(self) -> str:
        """All sentences, errors first; "running" if there are none."""
        return "; ".join([*self.errors, *self.warnings]) or "running"
