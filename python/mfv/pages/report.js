"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const slider = document.getElementById("state");
  const play = document.getElementById("play");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const frameTime = 250; // milliseconds a state while playing
  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: window.matchMedia("(hover: hover)").matches ? "hover" : false,
    modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]],
  };
  let playing = null;

  // A copy with the colours of the style sheet in place of their names.
  function resolved(value, style) {
    if (typeof value === "string") {
      const name = /^var\((--[\w-]+)\)$/.exec(value);
      return name ? style.getPropertyValue(name[1]).trim() : value;
    }
    if (Array.isArray(value)) {
      const hasText = value.some((item) => typeof item !== "number" && item !== null);
      return hasText ? value.map((item) => resolved(item, style)) : value;
    }
    if (value !== null && typeof value === "object") {
      return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, resolved(item, style)]));
    }
    return value;
  }

  // The traces of a figure at a state.
  function tracesAt(name, state) {
    const traces = data.figures[name].data.map((trace) => ({ ...trace }));
    if (name === "curve") {
      const point = traces[traces.length - 1];
      [point.x, point.y] = state.point.map((value) => [value]);
    }
    for (const trace of traces) {
      const values = state.curves[name] && state.curves[name][trace.name];
      if (values) {
        trace[trace.type === "heatmap" ? "z" : "y"] = values;
        trace.showlegend = trace.type === "scatter" && values.length > 0;
      }
    }
    return traces;
  }

  // The layout of a figure at a state: in the map a line where the state is, legends where there is more than one curve.
  function layoutAt(name, number) {
    const layout = { ...data.figures[name].layout };
    if (document.documentElement.hasAttribute("data-printing")) {
      const chart = document.getElementById(name);
      [layout.width, layout.height] = [chart.clientWidth, chart.clientHeight];
    }
    layout.showlegend = data.figures[name].data.length > 1;
    if (name === "map" && data.states.length > 1) {
      const band = { type: "rect", xref: "paper", x0: 0, x1: 1, y0: number - 0.5, y1: number + 0.5 };
      layout.shapes = [{ ...band, line: { color: "var(--point)", width: 2 }, fillcolor: "rgba(0,0,0,0)" }];
    }
    return layout;
  }

  function draw(names) {
    const number = Number(slider.value);
    const state = data.states[number - 1];
    const style = getComputedStyle(document.documentElement);
    document.getElementById("words").textContent = state.text;
    slider.setAttribute("aria-valuetext", state.text);
    return Promise.all(names.map((name) =>
      Plotly.react(name, resolved(tracesAt(name, state), style), resolved(layoutAt(name, number), style), config)));
  }

  const all = Object.keys(data.figures);
  const moved = all.filter((name) => name === "curve" || name === "map" || name in data.states[0].curves);

  function goTo(number) {
    slider.value = String((number - 1 + data.states.length) % data.states.length + 1);
    return draw(moved);
  }

  function stop() {
    clearInterval(playing);
    playing = null;
    play.textContent = "play";
    play.setAttribute("aria-pressed", "false");
  }

  function start() {
    playing = setInterval(() => goTo(Number(slider.value) + 1), frameTime);
    play.textContent = "stop";
    play.setAttribute("aria-pressed", "true");
  }

  function step(by) {
    stop();
    goTo(Number(slider.value) + by);
  }

  // Paper is white and narrow, and has no way to open what is folded.
  function setPrinting(isPrinting) {
    document.documentElement.toggleAttribute("data-printing", isPrinting);
    document.querySelectorAll("details").forEach((part) => { part.open = isPrinting; });
    draw(all).then(() => { if (!isPrinting) all.forEach((name) => Plotly.Plots.resize(name)); });
  }

  slider.addEventListener("input", () => { stop(); draw(moved); });
  document.getElementById("back").addEventListener("click", () => step(-1));
  document.getElementById("forward").addEventListener("click", () => step(1));
  play.addEventListener("click", () => (playing === null ? start() : stop()));
  dark.addEventListener("change", () => draw(all));
  window.addEventListener("beforeprint", () => setPrinting(true));
  window.addEventListener("afterprint", () => setPrinting(false));
  draw(all).then(() => document.documentElement.setAttribute("data-drawn", ""));
})();
