// The page in the browser: charts drawn as in a report, sections of a report, and tabs.
"use strict";
window.dash_clientside = window.dash_clientside || {};
window.dash_clientside.bench = (() => {
  const CONFIG = { displaylogo: false, responsive: true, doubleClick: false, showTips: false, topojsonURL: "", modeBarButtons: [["toImage"], ["zoom2d", "pan2d", "autoScale2d"]] };
  const same = () => window.dash_clientside.no_update;
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const charts = new Map(); // element that is drawn -> its chart
  const dark = matchMedia("(prefers-color-scheme: dark)");

  const shade = (one) => ({
    type: "rect", xref: "x", yref: "paper", x0: one.from, x1: one.to, y0: 0, y1: 1, layer: "below",
    line: { width: 0 }, fillcolor: colour(one.cut ? "cut" : "shade"),
  });
  const cursor = ([name, x]) => ({
    type: "line", xref: "x", yref: "paper", x0: x, x1: x, y0: 0, y1: 1, line: { color: colour("accent"), width: 1.5, dash: "dash" },
    label: { text: name, textposition: "end", font: { color: colour("accent") } },
  });

  async function draw(div, chart) {
    charts.set(div, chart);
    while (!window.Plotly) await new Promise((done) => setTimeout(done, 50));
    if (!div.isConnected || charts.get(div) !== chart) return; // a later chart has replaced it
    const width = Math.max(Math.round(div.clientWidth), 300);
    if (chart.height) div.style.height = `${chart.height}px`;
    const data = await Plots.traces(chart, null, width);
    if (charts.get(div) !== chart) return;
    data.forEach((trace) => {
      const before = (div.data || []).find((one) => one.name === trace.name && one.yaxis === trace.yaxis);
      if (before && before.visible !== undefined) trace.visible = before.visible;
    });
    const layout = Plots.layout(chart, null, width);
    if (chart.height) layout.height = chart.height; // else plotly keeps the height of the chart before
    layout.shapes = [...(chart.shades || []).map(shade), ...Object.entries(chart.cursors || {}).map(cursor)];
    await window.Plotly.react(div, data, layout, CONFIG);
    div.dataset.drawn = String(Number(div.dataset.drawn || 0) + 1);
  }

  const watcher = new IntersectionObserver((entries) => entries.forEach((entry) => {
    if (!entry.isIntersecting) return;
    watcher.unobserve(entry.target);
    draw(entry.target, charts.get(entry.target));
  }), { rootMargin: "300px" });

  // Sections of a report, escaped by the server, in the element `target`.
  function show(content) {
    if (!content) return same();
    const place = document.getElementById(content.target);
    place.querySelectorAll(".plot").forEach((div) => { window.Plotly && window.Plotly.purge(div); charts.delete(div); });
    place.innerHTML = content.html;
    place.querySelectorAll(".plot").forEach((div) => {
      charts.set(div, content.charts[div.id]);
      watcher.observe(div);
    });
    return content.stamp;
  }

  // A chart that the server makes for a request, or a sentence on why it cannot.
  async function fetched(what, asked) {
    const desk = location.pathname.split("/").pop();
    const answer = await fetch(`/${what}/${desk}`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(asked) });
    return answer.ok ? [await answer.json(), ""] : [null, await answer.text()];
  }

  // --- the plot of the run -----------------------------------------------------------------------------------------
  let view = { span: null };
  let turn = 0;

  async function redraw() {
    const mine = ++turn;
    const [chart] = await fetched("signals", view);
    const div = document.getElementById("signals");
    div.hidden = !chart;
    if (!chart || mine !== turn) return;
    await draw(div, chart);
    if (div.dataset.listens) return;
    div.dataset.listens = "yes";
    div.on("plotly_relayout", zoomed);
    div.on("plotly_doubleclick", () => zoom(null));
    div.on("plotly_click", (event) => view.over || window.dash_clientside.set_props("clicked", { data: { x: event.points[0].x, at: Date.now() } }));
  }

  function zoomed(change) {
    if (view.over) return; // the x axis is no time
    const range = change["xaxis.range"] || [change["xaxis.range[0]"], change["xaxis.range[1]"]];
    if (change["xaxis.autorange"]) zoom(null);
    else if (range[0] !== undefined && JSON.stringify(range) !== JSON.stringify(view.span)) zoom(range.map(Number));
  }

  function zoom(span) {
    view = { ...view, span };
    window.dash_clientside.set_props("span", { data: span });
    return redraw();
  }

  // Callbacks start what they draw and do not wait for it: Dash would hold back every other callback meanwhile.
  function signals(revision, run, shown, regime, other, marks, also, topics, over) {
    const span = run === view.run ? view.span : null;
    if (span !== view.span) window.dash_clientside.set_props("span", { data: null });
    view = { run, shown: [...shown, ...(topics || [])], regime, other, marks, also, over, span };
    redraw();
    return revision;
  }

  function whole() {
    zoom(null);
    return same();
  }

  // --- the response to sliders -------------------------------------------------------------------------------------
  let stops = {};
  let place = {};
  let told = 0; // timer that sends the stops to the page
  let busy = false;
  let waiting = false;

  async function response() {
    waiting = busy;
    if (busy) return; // the end of the last request starts the next one
    busy = true;
    const outputs = [...document.querySelectorAll("#sliders [data-told]")];
    const [chart, problem] = await fetched("response", { ...place, stops, names: outputs.map((one) => one.dataset.told) });
    const says = document.getElementById("response-says");
    says.textContent = problem;
    says.hidden = !problem;
    if (chart) {
      outputs.forEach((one) => { one.textContent = chart.values[one.dataset.told] || ""; });
      await draw(document.getElementById("response"), chart);
    }
    busy = false;
    if (waiting) await response();
  }

  function respond(values, _drawn, tab, run, span) {
    if (tab !== "sliders") return same();
    stops = { ...values };
    place = { run, span };
    response();
    return Date.now();
  }

  document.addEventListener("input", (event) => {
    if (!event.target.matches("#sliders input[type=range]")) return;
    stops = { ...stops, [JSON.parse(event.target.id).name]: Number(event.target.value) };
    response();
    clearTimeout(told);
    told = setTimeout(() => window.dash_clientside.set_props("values", { data: stops }), 400);
  });

  // --- the page ----------------------------------------------------------------------------------------------------
  // Asks the desk what runs, and whether there is something new to show.
  const seen = { revision: null, says: null, share: null, running: null, opened: 0 };
  let looking = false;

  function set(key, now, ...places) {
    if (seen[key] === now) return;
    seen[key] = now;
    places.forEach(([place, props]) => window.dash_clientside.set_props(place, props));
  }

  async function look() {
    if (looking) return;
    looking = true;
    try {
      const [now, problem] = await fetched("status", {});
      if (!now) throw new Error(problem);
      set("says", now.says, ["job-says", { children: now.says }], ["job", { hidden: !now.says }]);
      set("share", now.share, ["job-share", { value: String(now.share) }]);
      set("running", now.running, ["cancel", { hidden: !now.running }]);
      set("revision", now.revision, ["revision", { data: now.revision }]);
      if (now.opened !== seen.opened) set("opened", now.opened, ["tab", { value: now.tab }]);
    } catch (error) {
      const text = "The workbench does not answer; has it ended?";
      set("says", text, ["job-says", { children: text }], ["job", { hidden: false }], ["cancel", { hidden: true }]);
    } finally {
      looking = false;
    }
  }

  function acted() {
    look();
    return same();
  }

  // --- the live axis -----------------------------------------------------------------------------------------------
  let watching = 0;

  async function heard(mine) {
    const [now] = await fetched("live", {});
    if (!now || mine !== watching) return;
    document.getElementById("live-says").textContent = now.says;
    document.getElementById("set-says").textContent = now.answer;
    document.getElementById("live-status").innerHTML = now.status; // escaped by the server
    if (now.chart) await draw(document.getElementById("live-plot"), now.chart);
    setTimeout(() => mine === watching && heard(mine), 250);
  }

  function live(on, tab) {
    watching += 1;
    if (on && tab === "live") heard(watching);
    return same();
  }

  function tab(value) {
    document.querySelectorAll(".panel").forEach((panel) => { panel.hidden = panel.id !== `panel-${value}`; });
    document.querySelectorAll("#lead [data-tab]").forEach((step) => step.setAttribute("aria-pressed", step.dataset.tab === value));
    setTimeout(() => window.dispatchEvent(new Event("resize")), 0); // plots adapt to their new width
    return value;
  }

  // Effects whose name, signature, text or parameters hold every word that is typed.
  document.addEventListener("input", (event) => {
    if (event.target.id !== "search") return;
    const words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
    document.querySelectorAll("#effects .effect").forEach((one) => { one.hidden = !words.every((word) => one.dataset.words.includes(word)); });
    document.querySelectorAll("#effects > div").forEach((room) => { room.hidden = !room.querySelector(".effect:not([hidden])"); });
  });

  // On paper a plot is as wide as the sheet and not higher, whatever the window; afterwards as before.
  const PAPER = { width: 690, height: 900 }; // px: A4 without its margins, and a little less than its height

  function onPaper(paper) {
    charts.forEach((chart, div) => {
      if (!div.isConnected || !div.data) return;
      const height = chart.height && paper ? Math.min(chart.height, PAPER.height) : chart.height;
      if (height) div.style.height = `${height}px`;
      window.Plotly.relayout(div, { ...(paper ? { width: PAPER.width } : { width: null, autosize: true }), ...(height && { height }) });
    });
  }

  window.addEventListener("beforeprint", () => onPaper(true));
  window.addEventListener("afterprint", () => onPaper(false));

  // A step of the bar that opens a panel.
  function go() {
    const pressed = window.dash_clientside.callback_context.triggered_id;
    if (pressed) window.dash_clientside.set_props("tab", { value: pressed.replace("go-", "") });
    return same();
  }

  // A recording in the list: it is shown at once, whatever the server is busy with.
  document.addEventListener("click", (event) => {
    const name = event.target.closest && event.target.closest("[data-run]");
    if (!name) return;
    window.dash_clientside.set_props("run", { data: name.dataset.run });
    window.dash_clientside.set_props("tab", { value: "signals" });
  });

  // Presses inside lists that the server redraws: each is sent by itself, in their order.
  let presses = Promise.resolve();

  function press(control, value) {
    const asked = { what: control.dataset.press, of: JSON.parse(control.dataset.of), value };
    presses = presses.then(() => fetched("press", asked)).catch(() => {}).then(look); // `look` says that the server is gone
  }

  document.addEventListener("click", (event) => {
    const control = event.target.closest && event.target.closest("button[data-press]");
    if (control) press(control, null);
  });
  document.addEventListener("change", (event) => {
    const control = event.target.closest && event.target.closest("[data-press]");
    if (control) press(control, event.target.type === "checkbox" ? event.target.checked : event.target.value);
  });

  dark.addEventListener("change", () => charts.forEach((chart, div) => div.dataset.drawn && draw(div, { ...chart })));

  // A cell of the heat map leads to the plots of its run.
  document.addEventListener("click", (event) => {
    const link = event.target.closest && event.target.closest('#failures-content a[href^="#run-"]');
    if (!link) return;
    event.preventDefault();
    window.dash_clientside.set_props("wanted-run", { data: { number: Number(link.getAttribute("href").slice(5)), at: Date.now() } });
  });

  // Controls above a plot: open on a wide screen; on a telephone behind their summary, so that the plot comes first.
  const narrow = matchMedia("(max-width: 600px)");
  const fold = () => document.querySelectorAll("details.fold").forEach((one) => { one.open = !narrow.matches; });
  narrow.addEventListener("change", fold);

  const begin = setInterval(() => {
    if (!window.dash_clientside.set_props || !document.getElementById("tab")) return;
    clearInterval(begin);
    fold();
    look();
    setInterval(look, 500);
  }, 50);

  return { go, live, look: acted, respond, show, signals, tab, whole };
})();
