"""A readable page: light and dark, wide and narrow, on screen, by keyboard and by screen reader."""

from itertools import pairwise

from report.browser import Visit

from pneumo_ros.report.heat import STEPS

POSITION = "run-1-position_m"
TICK = f"getComputedStyle(document.querySelector('#{POSITION} .xtick text')).fill"

# Text with a contrast below 4.5 : 1 to its background (WCAG 2.2, 1.4.3), except in plots
CONTRASTS = """() => {
  const parse = (text) => [...text.match(/[\\d.]+/g).map(Number), 1].slice(0, 4);
  const line = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const light = ([r, g, b]) => 0.2126 * line(r / 255) + 0.7152 * line(g / 255) + 0.0722 * line(b / 255);
  const behind = (node) => {
    for (let one = node; one; one = one.parentElement) {
      const colour = parse(getComputedStyle(one).backgroundColor);
      if (colour[3] > 0.99) return colour;
    }
    return [255, 255, 255, 1];
  };
  const found = [];
  for (const node of document.querySelectorAll("body *")) {
    const own = [...node.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim());
    if (!own || node.closest("script, .plot, noscript, .skip, [hidden]") || !node.checkVisibility()) continue;
    const [back, ink] = [behind(node), parse(getComputedStyle(node).color)];
    const share = Number(getComputedStyle(node).opacity);
    const mixed = ink.slice(0, 3).map((v, i) => v * share + back[i] * (1 - share));
    const [low, high] = [light(mixed), light(back)].sort((x, y) => x - y);
    const ratio = (high + 0.05) / (low + 0.05);
    if (ratio < 4.5) found.push(`${ratio.toFixed(2)}: ${node.outerHTML.slice(0, 120)}`);
  }
  return found;
}"""


def test_text_stands_out_and_nothing_hangs_over_in_any_width(visit: Visit) -> None:
    visit.show(POSITION)
    for width in (1280, 820, 390):
        visit.page.set_viewport_size({"width": width, "height": 900})
        for scheme in ("light", "dark"):
            visit.page.emulate_media(color_scheme=scheme)
            assert visit.page.evaluate("document.documentElement.scrollWidth") <= width, width
            assert visit.page.evaluate(CONTRASTS) == [], (width, scheme)


def test_a_wide_window_is_used_and_a_narrow_one_filled(visit: Visit) -> None:
    visit.show(POSITION)
    for width in (1280, 820):
        visit.page.set_viewport_size({"width": width, "height": 900})
        drawn = f"document.querySelector('#{POSITION} .main-svg').getBoundingClientRect().width"
        visit.wait(f"{drawn} > {0.85 * width} && {drawn} < {width}")


def test_the_scale_of_the_heat_map_has_a_colour_for_each_step(visit: Visit) -> None:
    colours = visit.page.locator(".scale li").evaluate_all(
        "all => all.map(one => getComputedStyle(one).backgroundColor)"
    )
    assert len(set(colours)) == len(STEPS) + 1


def test_plots_follow_the_reader_from_light_to_dark(visit: Visit) -> None:
    visit.show(POSITION)
    light = visit.page.evaluate(TICK)
    visit.page.emulate_media(color_scheme="dark")
    visit.wait(f"{TICK} !== '{light}'")
    assert brightness(light) < 300 < brightness(visit.page.evaluate(TICK))


def brightness(colour: str) -> int:
    """Sum of red, green and blue of 'rgb(r, g, b)'."""
    return sum(map(int, colour.removeprefix("rgb(").removesuffix(")").split(",")))


def test_it_speaks_to_those_who_cannot_see_it(visit: Visit) -> None:
    page = visit.page
    assert page.get_attribute("html", "lang") == "en"
    assert "2 recordings" in page.title()
    assert page.locator("h1").count() == 1
    levels = [int(name[1]) for name in page.eval_on_selector_all("h1,h2,h3,h4", "all => all.map(one => one.tagName)")]
    assert all(after <= before + 1 for before, after in pairwise(levels))
    labels = page.eval_on_selector_all(".plot", "all => all.map(one => one.getAttribute('aria-label'))")
    assert min(map(len, labels)) > 40
    assert page.locator(".plot:not([role=img])").count() == 0
    assert page.locator("table:not(:has(caption))").count() == 0


def test_the_keyboard_reaches_everything(visit: Visit) -> None:
    visit.page.keyboard.press("Tab")
    assert visit.page.evaluate("document.activeElement.getAttribute('href')") == "#content"
    visit.page.locator("#overview tbody td a").first.focus()
    visit.page.keyboard.press("Enter")
    visit.wait("location.hash === '#run-1'")
