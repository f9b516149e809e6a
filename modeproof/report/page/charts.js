"use strict";
// A state chart: a picked state (click, Enter, Space) brings out its lines; the same again, or Escape, shows all.
(() => {
  const show = (chart, name) => {
    chart.classList.toggle("picked", name !== null);
    const lit = new Set([name]);
    for (const one of chart.querySelectorAll(".move, .entry")) {
      const from = one.dataset.from.split(" ");
      const on = name !== null && (from.includes(name) || one.dataset.to === name);
      one.classList.toggle("lit", on);
      if (on) for (const end of [one.dataset.to, ...(one.dataset.to === name || from.length === 1 ? from : [])]) lit.add(end);
    }
    for (const state of chart.querySelectorAll(".state")) {
      state.classList.toggle("lit", lit.has(state.dataset.state));
      state.setAttribute("aria-pressed", String(state.dataset.state === name));
    }
  };
  for (const chart of document.querySelectorAll("svg.chart")) {
    const pick = (target) => {
      const state = target.closest(".state");
      if (state) show(chart, state.getAttribute("aria-pressed") === "true" ? null : state.dataset.state);
    };
    chart.addEventListener("click", (event) => pick(event.target));
    chart.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") { event.preventDefault(); pick(event.target); }
      if (event.key === "Escape") show(chart, null);
    });
  }
  for (const button of document.querySelectorAll("figure.drawing button.fit")) {
    const figure = button.parentElement;
    button.hidden = figure.scrollWidth <= figure.clientWidth;
    button.addEventListener("click", () => {
      button.setAttribute("aria-pressed", String(figure.classList.toggle("whole")));
    });
  }
})();
