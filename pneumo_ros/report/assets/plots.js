// A chart of the page for plotly: traces and layout in the colours of the page's style.
"use strict";
const Plots = (() => {
  const coarse = matchMedia("(pointer: coarse)");

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  function outline(trace) {
    const x = [];
    const y = [];
    let begin = 0;
    const close = (end) => {
      for (let i = begin; i < end; i++) x.push(trace.x[i]), y.push(trace.y[i]);
      for (let i = end - 1; i >= begin; i--) x.push(trace.x[i]), y.push(trace.high[i]);
      if (end > begin) x.push(null), y.push(null);
      begin = end + 1;
    };
    trace.x.forEach((_, i) => (trace.y[i] === null || trace.high[i] === null) && close(i));
    close(trace.x.length);
    return { x, y };
  }

  function style(trace, panel, first) {
    const ink = colour(trace.role);
    const shown = {
      type: "scatter", mode: "lines", name: trace.name, yaxis: panel ? `y${panel + 1}` : "y",
      visible: trace.hidden ? "legendonly" : true, showlegend: first && trace.kind !== "band", legendgroup: trace.name,
      line: { color: ink, width: { quiet: 1, noise: 1, measured: 2.6 }[trace.role] || 1.4 },
    };
    if (trace.role === "free") shown.line.dash = "dash";
    if (trace.role === "noise") shown.line.dash = "dot";
    if (trace.kind === "steps") shown.line.shape = "hv";
    if (trace.kind === "dots") Object.assign(shown, { mode: "markers", marker: { color: ink, size: 6 } });
    if (trace.kind === "spans") shown.line.width = 7;
    if (trace.kind === "bars" || trace.kind === "removed") {
      Object.assign(shown.line, { width: 18, dash: "solid", color: trace.kind === "bars" ? ink : colour(`${trace.role}-band`) });
      shown.hoverinfo = "skip"; // the labels show the values
    }
    if (trace.kind === "labels") {
      Object.assign(shown, { mode: "text", text: trace.texts.map((text) => `\u00a0${text}`), textposition: "middle right", cliponaxis: false, showlegend: false, hoverinfo: "skip" });
      shown.textfont = { color: colour("ink") };
    }
    if (trace.kind === "area") Object.assign(shown, { fill: "tozeroy", line: { color: ink, width: 1 } });
    if (trace.kind === "band") {
      Object.assign(shown, { fill: "toself", fillcolor: colour(`${trace.role}-band`), hoverinfo: "skip" });
      shown.line.width = 0;
    }
    return shown;
  }

  async function points(trace, range, room) {
    if (trace.series) {
      trace.curve = trace.curve || (await Series.decode(trace.series));
      return Series.thin(trace.curve, range, room);
    }
    return trace.kind === "band" ? outline(trace) : { x: trace.x, y: trace.y };
  }

  async function traces(chart, range, room) {
    const named = new Set();
    const found = [];
    for (const [k, panel] of chart.panels.entries()) {
      for (const trace of panel.traces) {
        const first = chart.legend && !named.has(trace.name);
        named.add(trace.name);
        found.push({ ...style(trace, k, first), ...(await points(trace, range, room)) });
      }
    }
    return found;
  }

  // Plain numbers at 1, 2 and 5 of each decade; at the decades alone where there are many.
  function plainTicks([low, high]) {
    const found = [];
    for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); decade++) {
      for (const step of Math.log10(high / low) > 2.5 ? [1] : [1, 2, 5]) found.push(step * 10 ** decade);
    }
    return { tickmode: "array", tickvals: found, ticktext: found.map((value) => String(Number(value.toPrecision(1)))) };
  }

  function layout(chart, range, width) {
    const ink = colour("ink");
    const axis = { gridcolor: colour("grid"), zerolinecolor: colour("axis"), linecolor: colour("axis") };
    const names = chart.panels.flatMap((panel) => panel.ticks).map((name) => name.length);
    const left = Math.max(68, 7 * Math.max(0, ...names) + 12, chart.link && width > 700 ? 118 : 0);
    const rows = chart.panels.every((panel) => panel.ticks.length);
    const whole = chart.span && chart.logX ? chart.span.map(Math.log10) : chart.span; // plotly takes the range of a logarithmic axis in decades
    const total = chart.panels.reduce((sum, panel) => sum + panel.share, 0);
    const gap = chart.panels.length > 1 ? Math.min(0.05, 0.2 / (chart.panels.length - 1)) : 0;
    const result = {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: ink, size: width < 500 ? 11 : 12 },
      margin: { l: left, r: 12, t: chart.legend ? 28 : 10, b: 44 }, hovermode: rows ? "closest" : "x", dragmode: coarse.matches ? false : "zoom",
      legend: { orientation: "h", x: 0, y: 1.01, yanchor: "bottom", bgcolor: "rgba(0,0,0,0)" },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("axis"), activecolor: colour("accent") },
      hoverlabel: { bgcolor: colour("card"), bordercolor: colour("axis"), font: { color: ink } },
      xaxis: {
        ...axis, title: { text: chart.x, standoff: 8 }, hoverformat: chart.link ? ".3f" : ".4~g", type: chart.logX ? "log" : "linear", anchor: chart.panels.length > 1 ? `y${chart.panels.length}` : "y",
        zeroline: false, ...(range || whole ? { range: [...(range || whole)], autorange: false } : { autorange: true }),
      },
    };
    if (rows && chart.logX) Object.assign(result.xaxis, plainTicks(chart.span));
    let top = 1;
    chart.panels.forEach((panel, k) => {
      const height = ((1 - gap * (chart.panels.length - 1)) * panel.share) / total;
      const ticks = panel.ticks.length
        ? { tickmode: "array", tickvals: panel.ticks.map((_, i) => i), ticktext: panel.ticks, range: [panel.ticks.length - 0.3, -0.7], showgrid: false, zeroline: false }
        : { autorange: true };
      result[k ? `yaxis${k + 1}` : "yaxis"] = {
        ...axis, title: { text: panel.title, standoff: 6 }, domain: [Math.max(top - height, 0), top], hoverformat: ".5~g", fixedrange: true, ...ticks,
      };
      top -= height + gap;
    });
    return result;
  }

  return { traces, layout };
})();
