"""Times and memory of the workbench, in a real browser: start, idle, zoom of a long recording, response to a slider.

`python benchmarks/bench_workbench.py` needs Chromium and Playwright, as the tests do. The recording has 600,000 samples
of three signals. A zoom is timed from the end of the drag until the plot is redrawn, a slider from the key press
until the response is redrawn, both in the page, by the browser's clock.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.records import write_recording

sys.path.insert(0, str(Path(__file__).parents[1] / "test"))
from report.browser import chromium

SAMPLES = 600_000
TARGETS = {"start": 3.0, "idle": 150.0, "zoom": 0.3, "slider": 0.2}  # s, MB, s, s
REPEATS = 9
# Resolves with the milliseconds from an event until the plot `place` has been drawn once more.
WATCH = """([place, event]) => new Promise((done) => {
  const drawn = () => document.querySelector(place).dataset.drawn;
  const before = drawn();
  let began = null;
  document.addEventListener(event, () => { began = performance.now(); }, { once: true, capture: true });
  const again = () => (drawn() !== before && began !== null ? done(performance.now() - began) : setTimeout(again, 2));
  again();
})"""


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=(__doc__ or "").strip().splitlines()[0]).parse_args()
    with tempfile.TemporaryDirectory() as folder, chromium() as browser:
        bag = long_recording(Path(folder) / "ten_minutes")
        starts = [start_and_idle(Path(folder)) for _ in range(3)]
        rows = [
            ("start, until the address is printed", "start", [seconds for seconds, _ in starts], "s"),
            ("memory, idle", "idle", [megabytes for _, megabytes in starts], "MB"),
        ]
        zoom, slider = in_the_browser(browser, Path(folder), bag)
        rows += [
            (f"zoom of 3 x {SAMPLES:,} samples, until redrawn", "zoom", zoom, "s"),
            ("slider, until the response is drawn", "slider", slider, "s"),
        ]
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    print(f"{'':44}{'median':>10}{'worst':>10}   target")
    for words, key, values, unit in rows:
        worst = max(values)
        print(f"{words:44}{statistics.median(values):8.3g} {unit:2}{worst:8.3g} {unit:2} under {TARGETS[key]:g} {unit}")


def long_recording(path: Path) -> Path:
    """Ten minutes at 1 kHz with sensor noise; the motion is artificial."""
    rng, time_ = np.random.default_rng(1), np.arange(SAMPLES) * 1e-3
    swing = np.sin(0.7 * time_) * np.sin(0.011 * time_)
    pressures = [3e5 + sign * 1.5e5 * swing + rng.normal(0.0, 300.0, SAMPLES) for sign in (1.0, -1.0)]
    position = 0.3 * swing + rng.normal(0.0, 5e-6, SAMPLES)
    voltage = np.round(2.0 * np.sign(swing), 1)
    write_recording(path, time=time_, position=position, pressure_a=pressures[0], pressure_b=pressures[1],
                    voltage=voltage)  # fmt: skip
    return path


def served(folder: Path, *arguments: str) -> "tuple[subprocess.Popen[str], str]":
    """A running workbench and its address."""
    line = [sys.executable, "-m", "pneumo_ros", "workbench", "--port", "0", "--quiet", *arguments]
    process = subprocess.Popen(line, cwd=folder, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    return process, process.stdout.readline().strip()


def start_and_idle(folder: Path) -> tuple[float, float]:
    """Seconds until the address is printed, and megabytes a second later."""
    began = time.perf_counter()
    process, _ = served(folder)
    seconds = time.perf_counter() - began
    time.sleep(1.0)
    status = Path(f"/proc/{process.pid}/status").read_text()
    kilobytes = int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1])
    process.send_signal(2)
    process.wait(30)
    return seconds, kilobytes / 1000.0


def in_the_browser(browser: Any, folder: Path, bag: Path) -> tuple[list[float], list[float]]:
    """Seconds of zooms and of slider steps."""
    process, address = served(folder, str(bag))
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    try:
        page.goto(address)
        page.locator("#signals .main-svg").first.wait_for()
        page.wait_for_timeout(2000)
        zoom = [zoomed(page, k) for k in range(REPEATS)]
        return zoom, slid(page)
    finally:
        page.close()
        process.send_signal(2)
        process.wait(30)


def zoomed(page: Any, k: int) -> float:
    """Drag across the upper plot; from the release of the button until the plot is redrawn."""
    box = page.locator("#signals .nsewdrag").first.bounding_box()
    height = box["y"] + 0.5 * box["height"]
    begin = box["x"] + (0.2 + 0.04 * k) * box["width"]
    page.mouse.move(begin, height)
    page.mouse.down()
    page.mouse.move(begin + 0.3 * box["width"], height, steps=5)
    page.evaluate(f"() => {{ window.seen = ({WATCH})(['#signals', 'mouseup']); }}")
    page.mouse.up()
    seconds = 1e-3 * float(page.evaluate("() => window.seen"))
    page.wait_for_timeout(800)
    if k % 3 == 2:
        page.get_by_role("button", name="Whole run").click()
        page.wait_for_timeout(1200)
    return seconds


def slid(page: Any) -> list[float]:
    """Steps of a slider, each from the key press until the response is redrawn."""
    page.locator("#tab").get_by_text("Sliders", exact=True).click()
    page.locator("#response .main-svg").first.wait_for()
    slider = page.get_by_label("coulomb friction")
    slider.focus()
    page.wait_for_timeout(4000)
    found = []
    for _ in range(REPEATS):
        page.evaluate(f"() => {{ window.seen = ({WATCH})(['#response', 'keydown']); }}")
        page.keyboard.press("ArrowRight")
        found.append(1e-3 * float(page.evaluate("() => window.seen")))
        page.wait_for_timeout(700)
    return found


if __name__ == "__main__":
    main()
