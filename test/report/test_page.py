"""The page as text: its size, its policy, and its treatment of names."""

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from report.pages import HOSTILE, compared, many, report_of, result_of

from pneumo_ros.command.console import plain
from pneumo_ros.compare.compare import compare
from pneumo_ros.plant import load_model
from pneumo_ros.report.comparison import comparison_report
from pneumo_ros.report.markup import Html, data_block, html, table, tag
from pneumo_ros.report.page import page_html
from pneumo_ros.report.provenance import provenance

ELEMENTS = """html head meta title style body main header nav section details summary h1 h2 h3 p a ul li div figure
figcaption strong span b small table caption thead tbody tr th td button code pre noscript script
svg g path text"""


@pytest.mark.parametrize("minutes", [0.1, 3.0])
def test_ten_runs_stay_below_ten_megabytes(minutes: float) -> None:
    model, comparison = compared()
    page = page_html(report_of(model, many(comparison, 10, round(60.0 * minutes / comparison.runs[0].duration))))
    assert len(page.encode()) < 10e6


def test_short_runs_are_drawn_from_every_sample_and_long_ones_say_what_is_left_out() -> None:
    model, comparison = compared()
    assert "Drawn from every sample" in page_html(report_of(model, comparison))
    assert re.search(r"Drawn from two of every \d+ samples", page_html(report_of(model, many(comparison, 10, 30))))


def test_the_page_holds_the_json_of_the_verb() -> None:
    model, comparison = compared()
    text = page_html(report_of(model, comparison))
    (block,) = re.findall(r'<script type="application/json" id="result">(.*?)</script>', text, re.DOTALL)
    held = json.loads(block)
    assert {key: held[key] for key in result_of(comparison)} == result_of(comparison)
    assert held["provenance"]["versions"]["pneumo_ros"]


def test_no_name_enters_the_page_as_markup() -> None:
    text = page_html(report_of(*compared()))
    assert "<img" not in text
    assert "window.hacked" in text  # as text
    assert HOSTILE not in text


def test_links_of_the_heat_map_say_what_they_are_of() -> None:
    """Heard alone: the numbers of two runs may be equal, and all cells of a row lead to one place."""
    markup = page_html(report_of(*compared())).partition('id="overview"')[2].partition("</table>")[0]
    names = re.findall(r'<a [^>]*aria-label="([^"]*)"', markup)
    assert len(names) == markup.count("<a ") == 2 * 7
    assert len(set(names)) == len(names)
    assert sum(", momentum" in one for one in names) == 2


def test_a_policy_forbids_to_load_anything_and_to_run_anything_else() -> None:
    text = page_html(report_of(*compared()))
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', text)
    assert "default-src &#x27;none&#x27;" in policy
    assert "unsafe-eval" not in policy
    assert "script-src &#x27;sha256-" in policy
    assert not re.search(r"script-src[^;]*unsafe", policy)
    found = Elements(text)
    assert found.names <= set(ELEMENTS.split())
    assert not {name for name in found.attributes if name in ("src", "srcset", "action") or name.startswith("on")}
    assert all(link.startswith("#") for link in found.links)


class Elements(HTMLParser):
    """Names of the elements and attributes of a page as a browser reads it, and the targets of its links."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.names: set[str] = set()
        self.attributes: set[str] = set()
        self.links: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note an element."""
        self.names.add(tag)
        self.attributes |= {name for name, _ in attrs}
        self.links |= {value or "" for name, value in attrs if name == "href"}


def test_text_is_escaped_and_markup_stays() -> None:
    assert html("<b>&\"'") == "&lt;b&gt;&amp;&quot;&#x27;"
    assert html(["a<", Html("<br>"), ["&"]]) == "a&lt;<br>&amp;"
    assert (
        tag("td", "<", class_="n", title='"', hidden=True, role=None) == '<td class="n" title="&quot;" hidden>&lt;</td>'
    )
    assert "<script>" not in table(["<script>"], [["<script>", "<script>"]], "<script>")


def test_a_name_that_is_no_text_can_be_written() -> None:
    name = b"run_\xff".decode("utf-8", "surrogateescape")
    assert tag("p", name, title=name).encode("utf-8") == b'<p title="run_?">run_?</p>'
    data_block("x", {"name": name}).encode("utf-8")


def test_data_cannot_end_its_block() -> None:
    block = data_block("x", {"a": "</script><!--<script>&"})
    assert block.count("<") == 2
    assert json.loads(block.partition(">")[2].rpartition("<")[0])["a"] == "</script><!--<script>&"


def test_a_run_that_could_not_be_judged_or_that_diverged_has_its_page() -> None:
    model, comparison = compared()
    run = comparison.runs[0]
    still = replace(run.motion.run, position=0.0 * run.motion.run.position, input=0.0 * run.motion.run.input)
    found = compare(load_model(), [still], 0.5)
    lost = replace(found.runs[0], free={name: float("inf") for name in found.runs[0].free})
    found = replace(found, runs=(lost,))
    report = comparison_report(plain(found.as_dict()), found, model, provenance([], "axis", []))
    text = page_html(report)
    assert "not judged" in text
    assert "friction-map" not in text


def test_provenance_names_files_and_hashes(tmp_path: Path) -> None:
    bag = tmp_path / "bag"
    bag.mkdir()
    (bag / "data.mcap").write_bytes(b"abc")
    (tmp_path / "own.py").write_text("x = 1\n")
    found = provenance([bag], "paper", ["compare", "a b"], [tmp_path / "own.py"])
    data, machine, effects = found["files"]
    assert data["sha256"] == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert (data["bytes"], data["role"], machine["file"], effects["role"]) == (3, "recording", "paper", "effects")
    assert found["command"] == "pneumo compare 'a b'"
    assert found["created"].endswith("UTC")
