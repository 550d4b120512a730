"""A chart in plain text, for the terminal."""

from collections.abc import Mapping, Sequence


def chart(
    time: Sequence[float], curves: Mapping[str, Sequence[float]], unit: str, width: int = 72, height: int = 12
) -> str:
    """Curves over time, each drawn with its key, one character; later ones cover earlier ones.

    time (n,) [s] increasing; curves: mark -> values (n,) in `unit`. Every column shows the value in its middle.
    """
    low = min(min(values) for values in curves.values())
    high = max(max(values) for values in curves.values())
    span = high - low or 1.0
    canvas = [[" "] * width for _ in range(height)]
    for mark, values in curves.items():
        for column, value in enumerate(_sampled(time, values, width)):
            canvas[round((high - value) / span * (height - 1))][column] = mark
    labels = [f"{high:.3g} {unit}", *[""] * (height - 2), f"{low:.3g} {unit}"]
    margin = max(map(len, labels))
    rows = [f"{label:>{margin}} |{''.join(row).rstrip()}" for label, row in zip(labels, canvas, strict=True)]
    start, end = f"{time[0]:.1f}", f"{time[-1]:.1f} s"
    axis = f"{'':>{margin}} +{'-' * width}\n{'':>{margin}}  {start}{end:>{width - len(start)}}"
    return "\n".join([*rows, axis])


def _sampled(time: Sequence[float], values: Sequence[float], width: int) -> list[float]:
    """The value at the middle of each of `width` equal parts of the time."""
    length = (time[-1] - time[0]) / width
    result, index = [], 0
    for column in range(width):
        middle = time[0] + (column + 0.5) * length
        while index + 1 < len(time) and time[index + 1] <= middle:
            index += 1
        result.append(float(values[index]))
    return result
