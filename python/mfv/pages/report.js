"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const slider = document.getElementById("state");
  const play = document.getElementById("play");
  const frameTime = 250; // milliseconds a state while playing
  const config = {
    responsive: true,
    displaylogo: false,
    modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]],
  };
  let playing = null;

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
    const layout = { ...data.figures[name].layout, showlegend: data.figures[name].data.length > 1 };
    if (name === "map" && data.states.length > 1) {
      const band = { type: "rect", xref: "paper", x0: 0, x1: 1, y0: number - 0.5, y1: number + 0.5 };
      layout.shapes = [{ ...band, line: { color: "#d55e00", width: 2 }, fillcolor: "rgba(0,0,0,0)" }];
    }
    return layout;
  }

  function draw(names) {
    const number = Number(slider.value);
    const state = data.states[number - 1];
    document.getElementById("words").textContent = state.text;
    slider.setAttribute("aria-valuetext", state.text);
    return Promise.all(names.map((name) => Plotly.react(name, tracesAt(name, state), layoutAt(name, number), config)));
  }

  const all = Object.keys(data.figures);
  const moved = all.filter((name) => name === "curve" || name === "map" || name in data.states[0].curves);

  function stop() {
    clearInterval(playing);
    playing = null;
    play.textContent = "play";
    play.setAttribute("aria-pressed", "false");
  }

  function goOn() {
    slider.value = String(Number(slider.value) % data.states.length + 1);
    draw(moved);
  }

  function start() {
    playing = setInterval(goOn, frameTime);
    play.textContent = "stop";
    play.setAttribute("aria-pressed", "true");
  }

  slider.addEventListener("input", () => { stop(); draw(moved); });
  play.addEventListener("click", () => (playing === null ? start() : stop()));
  draw(all).then(() => document.documentElement.setAttribute("data-drawn", ""));
})();
