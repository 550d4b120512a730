"""Text and data of a page contain no markup for a browser."""

import json

import pytest

from pneumo_ros.report.markup import Html, data_block, html, tag


@pytest.mark.parametrize("text", ["</script >", "<!-- <script>", "a & b", "]]>", "\u2028"])
def test_nothing_in_data_can_end_their_element(text: str) -> None:
    block = data_block("series", {"name": text})
    inner = block.removeprefix('<script type="application/json" id="series">').removesuffix("</script>")
    assert not set("<>&") & set(inner)
    assert json.loads(inner) == {"name": text}


def test_text_is_escaped_once_and_markup_stays() -> None:
    assert html(["<b> & 'c'", Html("<br>")]) == "&lt;b&gt; &amp; &#x27;c&#x27;<br>"
    assert tag("p", "1 < 2", title='"quoted"') == '<p title="&quot;quoted&quot;">1 &lt; 2</p>'
