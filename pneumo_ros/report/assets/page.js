// Draws the charts of a page when they come into view, and links those that belong together. Reads the JSON blocks
// `charts` and `result` of the page; loads nothing.
"use strict";
(() => {
  const block = (id) => JSON.parse(document.getElementById(id).textContent);
  const charts = block("charts");
  const groups = new Map(); // link -> {range, members}
  const drawn = new Set();
  const dark = matchMedia("(prefers-color-scheme: dark)");

  const CONFIG = {
    displaylogo: false, responsive: true, doubleClick: false, topojsonURL: "",
    modeBarButtons: [["toImage"], ["zoom2d", "pan2d", "autoScale2d"]],
  };

  const groupOf = (div) => {
    const link = charts[div.id].link || div.id;
    if (!groups.has(link)) groups.set(link, { range: null, members: new Set() });
    return groups.get(link);
  };

  async function draw(div) {
    const chart = charts[div.id];
    const group = groupOf(div);
    const turn = (div.turn = (div.turn || 0) + 1);
    const data = await Plots.traces(chart, group.range, Math.max(Math.round(div.clientWidth), 300));
    if (turn !== div.turn) return; // a later call has replaced this one
    data.forEach((trace, i) => {
      if (div.data && div.data[i] && div.data[i].visible !== undefined) trace.visible = div.data[i].visible;
    });
    await Plotly.react(div, data, Plots.layout(chart, group.range, div.clientWidth), CONFIG);
    if (drawn.has(div)) return;
    drawn.add(div);
    div.on("plotly_relayout", (change) => follow(div, change));
    div.on("plotly_doubleclick", () => zoom(group, null));
    div.dataset.drawn = "yes";
  }

  function follow(div, change) {
    const group = groupOf(div);
    const range = change["xaxis.range"] || [change["xaxis.range[0]"], change["xaxis.range[1]"]];
    if (change["xaxis.autorange"]) zoom(group, null);
    else if (range[0] !== undefined && (!group.range || range[0] !== group.range[0] || range[1] !== group.range[1])) {
      zoom(group, [Number(range[0]), Number(range[1])]);
    }
  }

  function zoom(group, range) {
    group.range = range;
    group.members.forEach((div) => drawn.has(div) && draw(div).catch(trouble));
  }

  function trouble(error) {
    const place = document.getElementById("trouble");
    place.textContent = `A plot could not be drawn (${error.message}). The tables hold the same results.`;
    place.hidden = false;
  }

  const watcher = new IntersectionObserver(
    (entries) => entries.forEach((entry) => {
      if (!entry.isIntersecting) return;
      watcher.unobserve(entry.target);
      draw(entry.target).catch(trouble);
    }),
    { rootMargin: "400px" },
  );

  function start() {
    if (typeof DecompressionStream === "undefined") {
      trouble(new Error("this browser is older than 2023"));
      return;
    }
    document.querySelectorAll(".plot").forEach((div) => {
      groupOf(div).members.add(div);
      watcher.observe(div);
    });
    dark.addEventListener("change", () => drawn.forEach((div) => draw(div).catch(trouble)));
    document.addEventListener("click", (event) => {
      const button = event.target.closest("button[data-link]");
      if (!button) return;
      const group = groups.get(button.dataset.link);
      if (group) zoom(group, button.dataset.from ? [Number(button.dataset.from), Number(button.dataset.to)] : null);
    });
    const save = document.getElementById("save");
    if (save) save.addEventListener("click", download);
  }

  function download() {
    const text = JSON.stringify(block("result"), null, 1);
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
    link.download = `${document.title.replace(/[^\w-]+/g, "_")}.json`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  start();
})();
