// What the page does in the browser: charts in the report's own way of drawing, its sections, tabs, dropped files.
"use strict";
window.dash_clientside = window.dash_clientside || {};
window.dash_clientside.bench = (() => {
  const CONFIG = { displaylogo: false, responsive: true, doubleClick: false, topojsonURL: "", modeBarButtons: [["toImage"], ["zoom2d", "pan2d", "autoScale2d"]] };
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const drawn = new Map(); // plot of a section -> its chart
  const dark = matchMedia("(prefers-color-scheme: dark)");

  const shade = (one) => ({
    type: "rect", xref: "x", yref: "paper", x0: one.from, x1: one.to, y0: 0, y1: 1, layer: "below",
    line: { width: 0 }, fillcolor: colour(one.cut ? "cut" : "shade"),
  });
  const cursor = ([name, x]) => ({
    type: "line", xref: "x", yref: "paper", x0: x, x1: x, y0: 0, y1: 1, line: { color: colour("accent"), width: 1.5, dash: "dash" },
    label: { text: name, textposition: "end", font: { color: colour("accent") } },
  });

  // A chart of the server as a figure of dcc.Graph.
  async function figure(chart, theme) {
    if (!chart) return window.dash_clientside.no_update;
    const place = document.getElementById(chart.place);
    const width = place ? place.clientWidth : 900;
    const data = await Plots.traces(chart, null, width);
    const layout = Plots.layout(chart, null, width);
    if (place) place.style.height = `${chart.height}px`;
    layout.autosize = true;
    layout.shapes = [...(chart.shades || []).map(shade), ...Object.entries(chart.cursors || {}).map(cursor)];
    return { data, layout };
  }

  async function draw(div) {
    while (!window.Plotly) await new Promise((done) => setTimeout(done, 50));
    const chart = drawn.get(div);
    if (!chart || !div.isConnected) return;
    const width = Math.max(Math.round(div.clientWidth), 300);
    await window.Plotly.react(div, await Plots.traces(chart, null, width), Plots.layout(chart, null, width), CONFIG);
    div.dataset.drawn = "yes";
  }

  const watcher = new IntersectionObserver((entries) => entries.forEach((entry) => {
    if (!entry.isIntersecting) return;
    watcher.unobserve(entry.target);
    draw(entry.target);
  }), { rootMargin: "300px" });

  // Sections of a report, escaped by the server, in the element `target`.
  function show(content) {
    if (!content) return window.dash_clientside.no_update;
    const place = document.getElementById(content.target);
    place.querySelectorAll(".plot").forEach((div) => { window.Plotly && window.Plotly.purge(div); drawn.delete(div); });
    place.innerHTML = content.html;
    place.querySelectorAll(".plot").forEach((div) => {
      drawn.set(div, content.charts[div.id]);
      watcher.observe(div);
    });
    return content.stamp;
  }

  function tab(value) {
    document.querySelectorAll(".panel").forEach((panel) => { panel.hidden = panel.id !== `panel-${value}`; });
    setTimeout(() => window.dispatchEvent(new Event("resize")), 0); // plots take the width they now have
    return value;
  }

  dark.addEventListener("change", () => {
    drawn.forEach((_, div) => div.dataset.drawn && draw(div));
    window.dash_clientside.set_props("theme", { data: dark.matches ? "dark" : "light" });
  });

  // A cell of the heat map leads to the plots of its run.
  document.addEventListener("click", (event) => {
    const link = event.target.closest && event.target.closest('#failures-content a[href^="#run-"]');
    if (!link) return;
    event.preventDefault();
    window.dash_clientside.set_props("wanted-run", { data: { number: Number(link.getAttribute("href").slice(5)), at: Date.now() } });
  });

  return { figure, show, tab };
})();
