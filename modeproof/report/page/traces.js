"use strict";
// Traces: one at a time as a sequence diagram and as a scan table; a step is chosen by keyboard, buttons or a click.
(() => {
  const viewer = document.getElementById("trace-viewer");
  if (!viewer) return;
  const by = (id) => document.getElementById(id);
  const view = by("trace-view"), pick = by("trace-pick"), filters = [...viewer.querySelectorAll("[data-filter]")];
  const SVG = "http://www.w3.org/2000/svg";
  let stories = null, shown = null, at = 0;

  const make = (tag, attributes = {}, ...children) => {
    const one = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    one.append(...children);
    return one;
  };
  const draw = (tag, attributes = {}, text = null) => {
    const one = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    if (text !== null) one.textContent = text;
    return one;
  };
  const many = (value) => (Array.isArray(value) ? value : [value]);

  // ------------------------------------------------------------------------------------------------ the picker
  const SENTENCE = 90;
  const named = (story) => {
    const why = story.why ?? "";
    return `${story.document}: ${story.run}${why && ` · ${why.length > SENTENCE ? `${why.slice(0, SENTENCE)}…` : why}`}`;
  };
  const matching = () => Object.keys(stories).filter((id) => filters.every(
    (one) => one.value === "" || many(stories[id][one.dataset.filter]).includes(one.value)));
  const fill = () => {
    const ids = matching();
    pick.replaceChildren(...ids.map((id) => make("option", { value: id }, named(stories[id]))));
    by("trace-count").textContent = `${ids.length} of ${Object.keys(stories).length}`;
    if (ids.length) show(ids.includes(shown) ? shown : ids[0]);
  };
  const offer = () => {
    for (const one of filters) {
      const values = new Set(Object.values(stories).flatMap((story) => many(story[one.dataset.filter])));
      one.append(...[...values].sort().map((value) => make("option", { value }, value)));
    }
  };

  // ------------------------------------------------------------------------------------------------ one trace
  const show = (id) => {
    shown = id;
    const story = stories[id];
    pick.value = id;
    by("trace-title").textContent = `${story.document}: ${story.run}`;
    by("trace-about").replaceChildren(...(story.kind === "sequence" ? ofSequence(story) : [ofCounterexample(story)]));
    by("trace-link").href = `#${id}`;
    by("trace-table").replaceChildren(table(story));
    by("trace-diagram").replaceChildren(...diagram(story));
    go(0);
  };
  const ends = (text) => (/[.!?]$/.test(text) ? text : `${text}.`);
  const link = (kind, id) => make("a", { class: "id", href: `#${kind}-${id}` }, id);
  const ofSequence = (story) => [
    `${ends(story.why)} The answer is demanded by `,
    ...(story.findings.length ? ["our decision ", ...story.findings.map((id) => link("finding", id))] : [`the ${story.basis}`]),
    "; clauses ", ...story.clauses.flatMap((id, n) => [n ? ", " : "", link("clause", id)]), ".",
    story.parameters ? ` Parameters: ${story.parameters}.` : "",
    story.constant ? ` The same in every scan: ${story.constant}.` : ""];
  const ofCounterexample = (story) => {
    const findings = [...story.findings, ...story.assumptions];
    return `Breaks ${story.property}; environment ${story.environment || "not named"}`
      + (findings.length ? `; shown for ${findings.join(", ")}` : "")
      + (story.loop ? `; at the end: ${story.loop}` : "")
      + (story.wires ? "." : ". There is no walk of this trace here, so it shows the variables of the specification.")
      + (story.constant ? ` The same in every row: ${story.constant}.` : "");
  };
  const table = (story) => {
    const head = make("tr", {}, ...["", "step", "who", "executes", ...story.columns].map((text) => make("th", { scope: "col" }, text)));
    const body = story.rows.map((row, n) => make("tr", { "data-step": n },
      make("td", { class: "mark", "aria-hidden": "true" }), make("td", {}, String(n)), make("td", {}, row.by), make("td", {}, row.step),
      ...row.cells.map((text, k) => row.changed.includes(k)
        ? make("td", { class: "changed" }, make("span", { "aria-hidden": "true" }, "▸"), text)
        : make("td", {}, text))));
    return make("table", {}, make("thead", {}, head), make("tbody", {}, ...body));
  };

  const CHAR = 6.7, LINE = 14, LEFT = 46, GAP = 40, WIDE = 30;
  const inLines = (signals) => signals.reduce((found, text) => {
    const last = found.length - 1;
    if (last >= 0 && found[last].length + text.length + 2 <= WIDE) found[last] += `, ${text}`; else found.push(text);
    return found;
  }, []);
  const diagram = (story) => {
    const place = new Map(story.lanes.map((lane, n) => [lane.id, n]));
    const widths = story.lanes.map((lane) => lane.title.length * CHAR + 20);
    const apart = story.lanes.map(() => 120);
    for (const row of story.rows) {
      const lane = place.get(row.who) ?? 0;
      widths[lane] = Math.max(widths[lane], row.step.length * CHAR + 20);
      for (const message of row.messages) {
        const [a, b] = [place.get(message.source), place.get(message.target)].sort((x, y) => x - y);
        const needed = Math.max(...inLines(message.signals).map((text) => text.length)) * CHAR + 24;
        for (let k = a; k < b; k++) apart[k] = Math.max(apart[k], needed / (b - a));
      }
    }
    const xs = [LEFT + widths[0] / 2];
    for (let k = 1; k < story.lanes.length; k++) xs.push(xs[k - 1] + Math.max(apart[k - 1], (widths[k - 1] + widths[k]) / 2 + GAP));
    const longest = Math.max(0, ...story.rows.flatMap((row) => row.instead).map((text) => text.length + 2));
    const width = Math.max(xs[xs.length - 1] + widths[widths.length - 1] / 2 + 200, LEFT + longest * CHAR + 20);
    const picture = draw("svg", { width, role: "img", "aria-label": `sequence diagram of ${story.run}; the table below says the same` });
    const marks = draw("defs");
    const marker = draw("marker", { id: "trace-head", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 8, markerHeight: 8, markerUnits: "userSpaceOnUse", orient: "auto" });
    marker.append(draw("path", { d: "M0 0L8 4L0 8z" }));
    marks.append(marker);
    picture.append(marks);
    const lines = draw("g");
    picture.append(lines);
    const heads = draw("svg", { class: "heads", width, height: 26, viewBox: `0 0 ${width} 26`, "aria-hidden": "true" });
    story.lanes.forEach((lane, n) => heads.append(draw("text", { class: "head", x: xs[n], y: 18, "text-anchor": "middle" }, lane.title)));
    let y = 4, before = {};
    story.rows.forEach((row, n) => {
      const group = draw("g", { class: "step", "data-step": n });
      const top = y, lane = place.get(row.who) ?? 0;
      const band = draw("rect", { class: "band", x: 1, y: top, width: width - 2 });
      group.append(band, draw("text", { class: "mark", x: 6, y: top + 15 }, "▶"), draw("text", { x: 40, y: top + 15, "text-anchor": "end" }, String(n)));
      const wide = row.step.length * CHAR + 14;
      y += 4;
      group.append(draw("rect", { class: "act", x: xs[lane] - wide / 2, y, width: wide, height: 17, rx: 3 }),
        draw("text", { x: xs[lane], y: y + 12.5, "text-anchor": "middle" }, row.step));
      y += 20;
      for (const message of row.messages) {
        const a = xs[place.get(message.source)], b = xs[place.get(message.target)];
        for (const text of inLines(message.signals)) {
          y += LINE;
          group.append(draw("text", { x: (a + b) / 2, y: y - 3, "text-anchor": "middle" }, text));
        }
        group.append(draw("path", { class: "arrow", d: `M${a} ${y}H${b}`, "marker-end": "url(#trace-head)" }));
        y += 4;
      }
      for (const [device, state] of Object.entries(row.states)) {
        if (n > 0 && before[device] === state) continue;
        y += LINE;
        group.append(draw("text", { class: "in", x: xs[place.get(device)], y: y - 3, "text-anchor": "middle" }, `is in ${state}`));
      }
      before = { ...before, ...row.states };
      for (const text of row.instead) {
        y += LINE;
        group.append(draw("text", { class: "instead", x: LEFT, y: y - 3 }, `⚠ ${text}`));
      }
      y += 4;
      band.setAttribute("height", y - top);
      picture.append(group);
    });
    for (const x of xs) lines.append(draw("path", { class: "lifeline", d: `M${x} 0V${y}` }));
    picture.setAttribute("height", y + 6);
    picture.setAttribute("viewBox", `0 0 ${width} ${y + 6}`);
    return [heads, picture];
  };

  // ------------------------------------------------------------------------------------------------ one step
  const within = (box, one) => {
    const outer = box.getBoundingClientRect(), inner = one.getBoundingClientRect();
    if (inner.top < outer.top + 40) box.scrollTop -= outer.top + 40 - inner.top;
    else if (inner.bottom > outer.bottom) box.scrollTop += inner.bottom - outer.bottom + 8;
  };
  const go = (step) => {
    const story = stories[shown];
    at = Math.max(0, Math.min(step, story.rows.length - 1));
    view.dataset.step = at;
    view.dataset.trace = shown;
    for (const one of by("trace-table").querySelectorAll("tr[data-step]")) {
      const now = Number(one.dataset.step) === at;
      if (now) one.setAttribute("aria-current", "step"); else one.removeAttribute("aria-current");
      one.firstChild.textContent = now ? "▶" : "";
      if (now) within(by("trace-table"), one);
    }
    for (const one of by("trace-diagram").querySelectorAll(".step")) {
      const n = Number(one.dataset.step);
      one.classList.toggle("now", n === at);
      one.classList.toggle("later", n > at);
      if (n === at) within(by("trace-diagram"), one);
    }
    const row = story.rows[at];
    const states = Object.entries(row.states).map(([device, state]) =>
      `${story.lanes.find((lane) => lane.id === device)?.title ?? device} is in ${state}`).join(", ");
    by("trace-step").replaceChildren(
      `Step ${at} of ${story.rows.length - 1}: ${row.by ? `${row.by} executes ` : ""}${row.step}`,
      make("span", { class: "states" }, states),
      ...row.instead.map((text) => make("span", { class: "instead" }, `⚠ ${text}`)));
    for (const [name, end] of [["first", at === 0], ["back", at === 0], ["next", at === story.rows.length - 1], ["last", at === story.rows.length - 1]]) {
      viewer.querySelector(`[data-go=${name}]`).setAttribute("aria-disabled", String(end));
    }
  };
  const MOVES = { first: () => 0, back: () => at - 1, next: () => at + 1, last: () => Infinity };
  const KEYS = { Home: "first", ArrowLeft: "back", ArrowUp: "back", ArrowRight: "next", ArrowDown: "next", End: "last" };
  view.addEventListener("keydown", (event) => {
    const move = KEYS[event.key];
    if (!move || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    go(MOVES[move]());
  });
  view.addEventListener("click", (event) => {
    const button = event.target.closest("[data-go]");
    const step = event.target.closest("tr[data-step], .step");
    if (button) go(MOVES[button.dataset.go]()); else if (step) go(Number(step.dataset.step));
  });

  // ------------------------------------------------------------------------------------------------ the beginning
  let opening = null;
  const open = async () => {
    opening ??= payloadJson("trace-stories").then((found) => {
      stories = found;
      offer();
      fill();
      for (const one of filters) one.addEventListener("change", fill);
      pick.addEventListener("change", () => { show(pick.value); history.replaceState(null, "", `#${pick.value}`); });
    });
    await opening;
  };
  const follow = async () => {
    const id = decodeURIComponent(location.hash.slice(1));
    if (!id.startsWith("trace-")) return;
    await open();
    if (!Object.hasOwn(stories, id)) return;
    for (const one of filters) one.value = "";
    shown = id;
    fill();
    viewer.scrollIntoView();
    view.focus({ preventScroll: true });
  };
  by("traces").dataset.live = "";
  viewer.hidden = false;
  by("trace-filter").addEventListener("submit", (event) => event.preventDefault());
  new IntersectionObserver((seen, watcher) => {
    if (seen.some((one) => one.isIntersecting)) { watcher.disconnect(); open(); }
  }, { rootMargin: "400px" }).observe(viewer);
  addEventListener("hashchange", follow);
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a.trace");
    if (link && link.hash === location.hash) follow();
  });
  follow();
})();
