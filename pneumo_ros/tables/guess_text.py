"""The guessed map as a YAML file, a comment at each line."""

import json

from pneumo_ros.tables.guess import Guess, Guesses
from pneumo_ros.tables.map_file import USUAL_ATMOSPHERE
from pneumo_ros.tables.signals import SIGNALS


def map_text(found: Guesses, name: str) -> str:
    """The map of the table `name`, which `load_map` reads where the guess is complete."""
    lines = [
        f"# Map of {name}, guessed. Check every line: column, unit, sign (positive extends the rod), offset, gauge.",
        "# value = sign * (scale * column + offset), in the unit given; gauge: true adds the atmosphere's pressure.",
    ]
    lines += [f"# Not decided: {sentence}" for sentence in found.open]
    if found.time is None:
        lines.append("# time: {rate: HZ}")
    else:
        lines.append(f"time: {{column: {_quoted(found.time.column)}, unit: {found.time.unit}}}  # {found.time.why}")
    why = (
        "a measured force, and neither a driving force nor a command"
        if found.imposed
        else "or imposed, by a test machine"
    )
    lines.append(f"motion: {'imposed' if found.imposed else 'free'}  # {why}")
    if any(one.gauge is not None or "pressure" in signal for signal, one in found.signals.items()):
        lines.append(f"constants: {{atmospheric_pressure: {USUAL_ATMOSPHERE}}}  # Pa; the usual one, not measured")
    lines.append("signals:")
    lines += [_line(signal, one) for signal, one in found.signals.items()]
    lines += [f"#  {signal}: {{column: NAME, unit: UNIT}}" for signal in ("position",) if signal not in found.signals]
    if found.unused:
        lines.append(
            "# Not used; to keep one in the recording, name it in the section others: "
            "{name: {column: NAME, unit: UNIT}}"
        )
        lines += [f"#  {json.dumps(column, ensure_ascii=False)}: {span}" for column, span in found.unused.items()]
    return "\n".join(lines) + "\n"


def _line(signal: str, one: Guess) -> str:
    """The entry of one signal."""
    keys = [f"column: {_quoted(one.column)}", f"unit: {_quoted(one.unit)}", "sign: 1", "scale: 1", "offset: 0"]
    keys += [f"gauge: {str(one.gauge).lower()}"] if one.gauge is not None else []
    keys += [f"bits: {one.bits}"] if one.bits is not None else []
    span = f"{one.low:.4g} to {one.high:.4g} {one.unit}"
    return f"  {signal}: {{{', '.join(keys)}}}  # {SIGNALS[signal].words}: {one.why}; {span}"


def _quoted(text: str) -> str:
    """A text as YAML reads it back, whatever letters it has; JSON is YAML."""
    return json.dumps(text)
