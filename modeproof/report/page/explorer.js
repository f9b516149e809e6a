// Walks an exported graph. Nothing is decided here: each step is looked up in the graph's table of moves.
(() => {
  const by = (id) => document.getElementById(id);
  const box = by("explore");
  if (!box) return;
  box.hidden = false;

  let about = null; // what registers and evidence say about devices
  let graph = null; // the graph that is open
  let letters = new Map(); // its inputs, by their places in the lists of values
  let trail = []; // the inputs taken, those that Back went behind as well
  let at = 0; // how many of them have been taken
  let chosen = []; // the input of the next scan, as places in the lists of values
  let opening = 0;

  const node = (name, text = "", more = {}) => {
    const made = document.createElement(name);
    if (text !== "") made.textContent = text;
    for (const [key, value] of Object.entries(more)) made.setAttribute(key, value);
    return made;
  };
  const say = (text) => { by("explore-said").textContent = text; };

  // ---------------------------------------------------------------- values
  const signal = (name) => about.signals[name] ?? { type: "", why: "" };
  const show = (name, value, type = signal(name).type) => {
    if (value === null) return "none";
    if (typeof value === "boolean") return value ? "TRUE" : "FALSE";
    if (Array.isArray(value)) return value.length ? value.map((one) => show("", one, "")).join(", ") : "none";
    if (type === "ms" || name === "dt_ms") return `${value} ms`;
    if (type === "word" && /^[0-9A-F]{4}$/.test(value)) {
      const code = about.codes[name];
      const means = !code || value === "0000" ? "" : value in code.words ? ` (${code.says} ${code.words[value]})` : " (no code)";
      return `${value}${means}`;
    }
    return typeof value === "object" ? JSON.stringify(value) : String(value);
  };
  const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

  // ---------------------------------------------------------------- the graph
  const stateAfter = (count) => {
    let state = graph.initial;
    for (let n = 0; n < count; n += 1) state = move(state, trail[n]).next;
    return state;
  };
  const move = (state, letter) => {
    const found = graph.moves[state][graph.columns[letter]];
    return { step: graph.steps[Math.floor(found / graph.states.length)], next: found % graph.states.length };
  };
  const control = (state) => show("", graph.states[state][graph.control], "");
  const name = (state) => {
    const rest = graph.memory
      .map((one, n) => (n === graph.control ? "" : `${one.name} ${show(one.name, graph.states[state][n], one.type)}`))
      .filter((one) => one);
    return rest.length ? `${control(state)} (${rest.join(", ")})` : control(state);
  };
  const change = (state, next) => {
    if (next === state) return "the same state";
    const rest = graph.memory.flatMap((one, n) => {
      const value = graph.states[next][n];
      return n === graph.control || same(value, graph.states[state][n]) ? [] : [`${one.name} ${show(one.name, value, one.type)}`];
    });
    return rest.length ? `${control(next)} (${rest.join(", ")})` : control(next);
  };
  const letterOf = (places) => letters.get(places.join(" "));
  const input = (letter) => graph.inputs.letters[letter];
  const inputValue = (n, place) => show(graph.inputs.names[n], graph.inputs.values[n][place]);
  const outputs = (state, letter) => {
    const row = graph.outputs.rows[graph.outputs.row_of[state]];
    const found = graph.outputs.names.map((one, n) => [one, row[n]]);
    for (const [output, given] of Object.entries(graph.passed)) {
      const n = graph.inputs.names.indexOf(given);
      found.push([output, letter === null ? null : graph.inputs.values[n][input(letter)[n]]]);
    }
    return found;
  };
  const values = (count) => {
    const state = stateAfter(count);
    const letter = count ? trail[count - 1] : null;
    return [
      ...graph.memory.map((one, n) => ["memory", one.name, graph.states[state][n], one.type]),
      ...outputs(state, letter).map(([one, value]) => ["output", one, value, signal(one).type]),
    ];
  };
  const shortest = (target) => {
    const before = new Map([[graph.initial, null]]);
    const queue = [graph.initial];
    for (const state of queue) {
      if (state === target) break;
      graph.columns.forEach((column, letter) => {
        const next = graph.moves[state][column] % graph.states.length;
        if (!before.has(next)) { before.set(next, [state, letter]); queue.push(next); }
      });
    }
    const path = [];
    for (let way = before.get(target); way; way = before.get(way[0])) path.unshift(way[1]);
    return path;
  };

  // ---------------------------------------------------------------- drawing
  const clauses = (step) => about.actions[step]?.clauses ?? [];
  const links = (step) => [["clause", clauses(step)], ["finding", about.actions[step]?.findings ?? []]]
    .flatMap(([kind, ids]) => ids.map((id) => node("a", id, { class: "id", href: `#${kind}-${id}` })))
    .flatMap((link, n) => [document.createTextNode(n ? ", " : ""), link]);

  const drawValues = () => {
    const state = stateAfter(at);
    by("explore-where").textContent = `State: ${control(state)}${at ? `, after ${at} scan${at > 1 ? "s" : ""}` : ", after power-up"}`;
    const was = at ? values(at - 1) : null;
    const table = by("explore-values");
    const head = node("tr");
    for (const one of ["name", "value", "before", "what it is"]) head.append(node("th", one, { scope: "col" }));
    const bodies = { memory: node("tbody"), output: node("tbody") };
    for (const [kind, text] of [["memory", "Memory"], ["output", "Outputs"]]) {
      const row = node("tr");
      row.append(node("th", text, { scope: "rowgroup", colspan: "4", class: "group" }));
      bodies[kind].append(row);
    }
    values(at).forEach(([kind, label, value, type], n) => {
      const changed = was !== null && !same(was[n][2], value);
      const row = node("tr", "", changed ? { class: "changed" } : {});
      row.append(node("th", label, { scope: "row" }), node("td", show(label, value, type)));
      row.append(node("td", changed ? `changed, was ${show(label, was[n][2], type)}` : was ? "same" : ""), node("td", signal(label).why));
      bodies[kind].append(row);
    });
    const top = node("thead");
    top.append(head);
    table.replaceChildren(top, bodies.memory, bodies.output);
  };

  const drawInputs = () => {
    const place = by("explore-inputs");
    place.replaceChildren();
    graph.inputs.names.forEach((label, n) => {
      const list = node("select", "", { id: `explore-input-${n}`, title: signal(label).why });
      graph.inputs.values[n].forEach((_, k) => list.append(node("option", inputValue(n, k), { value: String(k) })));
      list.addEventListener("change", () => choose(n, Number(list.value)));
      place.append(node("label", label === "dt_ms" ? "time since the scan before" : label, { for: list.id }), list);
    });
    const stands = graph.classes.map((one) => {
      const fields = Object.entries(one.fields).map(([field, value]) => `${field} = ${show(field, value)}`).join(", ");
      return `${fields} stands for ${one.members} other inputs (${one.name}), which the comparison tried in its place.`;
    });
    if (graph.copied) stands.push(`${graph.copied.words.join(" and ")} in ${graph.copied.fields.join(", ")} stand for any words but zero: they are passed on unread.`);
    stands.push(`Time comes in steps of ${graph.tick_ms} ms.`);
    by("explore-stands").replaceChildren(...stands.map((one) => node("p", one)));
  };

  // The input with this value that is like the chosen one in most other places.
  const nearest = (n, k) => {
    let best = -1;
    let found = 0;
    graph.inputs.letters.forEach((one, letter) => {
      if (one[n] !== k) return;
      const alike = one.filter((value, m) => value === chosen[m]).length;
      if (alike > best) { best = alike; found = letter; }
    });
    return found;
  };
  const choose = (n, k) => {
    const wanted = chosen.map((value, m) => (m === n ? k : value));
    const exact = letterOf(wanted);
    const letter = exact ?? nearest(n, k);
    const moved = input(letter).flatMap((value, m) => (m !== n && value !== chosen[m] ? [`${graph.inputs.names[m]} = ${inputValue(m, value)}`] : []));
    chosen = [...input(letter)];
    drawChosen();
    say(`${preview()}${moved.length ? `. The graph has no such input; also set: ${moved.join(", ")}` : ""}`);
  };
  const preview = () => {
    const { step, next } = move(stateAfter(at), letterOf(chosen));
    return `This input leads by ${step} to ${name(next)}`;
  };
  const drawChosen = () => {
    chosen.forEach((place, n) => { by(`explore-input-${n}`).value = String(place); });
    by("explore-preview").textContent = `${preview()}.`;
  };

  // By which inputs a group of them is told: of each place the values that occur, where not all do.
  const condition = (group) => {
    const occur = graph.inputs.names.map((_, n) => new Set(group.map((letter) => input(letter)[n])));
    const fitting = graph.inputs.letters.filter((one) => one.every((k, n) => occur[n].has(k))).length;
    const parts = graph.inputs.names.flatMap((label, n) => {
      const places = [...occur[n]].sort((a, b) => a - b);
      return places.length < graph.inputs.values[n].length ? [`${label} = ${places.map((k) => inputValue(n, k)).join(" or ")}`] : [];
    });
    const whole = fitting === group.length;
    if (!parts.length) return whole ? "every input" : "no value decides alone";
    return `${parts.join("; ")}${whole ? "" : "; and not every such input"}`;
  };

  const drawActions = () => {
    const state = stateAfter(at);
    const groups = new Map();
    graph.columns.forEach((column, letter) => {
      const found = graph.moves[state][column];
      if (!groups.has(found)) groups.set(found, []);
      groups.get(found).push(letter);
    });
    const all = graph.columns.length;
    const head = node("tr");
    for (const one of ["action", "cites", "next state", "inputs that lead there", "how many", "take it"]) head.append(node("th", one, { scope: "col" }));
    const body = node("tbody");
    for (const found of [...groups.keys()].sort((a, b) => a - b)) {
      const group = groups.get(found);
      const { step, next } = move(state, group[0]);
      const row = node("tr");
      const first = node("th", "", { scope: "row" });
      first.append(node("code", step));
      const cited = node("td");
      cited.append(...links(step));
      const last = node("td");
      const take = node("button", "Take", { type: "button", "aria-label": `Take ${step} to ${name(next)}` });
      take.addEventListener("click", () => { scan(like(group)); by("explore-where").focus(); });
      last.append(take);
      row.append(first, cited, node("td", change(state, next)), node("td", condition(group)));
      row.append(node("td", `${group.length.toLocaleString("en")} of ${all.toLocaleString("en")}`, { class: "n" }), last);
      body.append(row);
    }
    const top = node("thead");
    top.append(head);
    by("explore-actions").replaceChildren(top, body);
  };
  // Of a group of inputs the one that is most like the chosen one.
  const like = (group) => {
    let best = -1;
    let found = group[0];
    for (const letter of group) {
      const alike = input(letter).filter((value, n) => value === chosen[n]).length;
      if (alike > best) { best = alike; found = letter; }
    }
    return found;
  };

  const drawTrail = () => {
    const list = by("explore-trail");
    const entry = (count, text) => {
      const line = node("li");
      const button = node("button", text, { type: "button" });
      if (count === at) button.setAttribute("aria-current", "step");
      button.addEventListener("click", () => { go(count); by("explore-trail").children[count].firstChild.focus(); });
      line.append(button);
      if (count > at) line.append(node("span", " (ahead)", { class: "ahead" }));
      return line;
    };
    const lines = [entry(0, `power-up: ${control(graph.initial)}`)];
    let state = graph.initial;
    trail.forEach((letter, n) => {
      const before = n ? input(trail[n - 1]) : null;
      const given = input(letter).flatMap((value, k) => (before === null || before[k] !== value ? [`${graph.inputs.names[k]} = ${inputValue(k, value)}`] : []));
      const { step, next } = move(state, letter);
      lines.push(entry(n + 1, `${step} to ${control(next)}; ${given.length ? given.join(", ") : "same inputs"}`));
      state = next;
    });
    list.replaceChildren(...lines);
  };

  const drawProperties = () => {
    const step = at ? move(stateAfter(at - 1), trail[at - 1]).step : null;
    const shares = (one) => (step === null ? [] : one.clauses.filter((id) => clauses(step).includes(id)));
    const rows = [...about.properties].sort((a, b) => (shares(b).length > 0) - (shares(a).length > 0));
    by("explore-properties").replaceChildren(...rows.map((one) => {
      const line = node("li");
      line.append(node("a", one.id, { class: "id", href: `#property-${about.document}-${one.id}` }), ` of ${one.of}: ${one.sentence}`);
      if (graph.checked.includes(one.id)) line.append(node("span", " ✓ Holds in the run that printed this graph.", { class: "good" }));
      const shared = shares(one);
      if (shared.length) line.append(node("span", ` → cites ${shared.join(", ")}, as ${step} does.`, { class: "here" }));
      return line;
    }));
  };

  const draw = () => {
    drawValues();
    drawChosen();
    drawActions();
    drawTrail();
    drawProperties();
    by("explore-state").value = String(stateAfter(at));
    by("explore-back").disabled = at === 0;
    by("explore-reset").disabled = trail.length === 0;
    by("explore-on").disabled = at === trail.length;
    const path = `#explore-${graph.id}/${trail.slice(0, at).join(".")}`;
    by("explore-link").setAttribute("href", path);
    by("explore-link").hidden = false;
    history.replaceState(null, "", path);
  };

  // ---------------------------------------------------------------- moving
  const told = () => {
    const state = stateAfter(at);
    if (!at) return `Power-up: ${name(state)}.`;
    const { step } = move(stateAfter(at - 1), trail[at - 1]);
    const was = values(at - 1);
    const changed = values(at).flatMap(([, label, value, type], n) => (same(value, was[n][2]) ? [] : [`${label} = ${show(label, value, type)}`]));
    return `Scan ${at}: ${step}. Now in ${control(state)}. ${changed.length ? `Changed: ${changed.join(", ")}.` : "Nothing changed."}`;
  };
  const go = (count) => {
    at = Math.max(0, Math.min(trail.length, count));
    if (at) chosen = [...input(trail[at - 1])];
    draw();
    say(told());
  };
  const scan = (letter) => {
    trail = [...trail.slice(0, at), letter];
    go(at + 1);
  };
  const reset = () => {
    trail = [];
    go(0);
  };

  const open = async (id, path = []) => {
    const turn = (opening += 1);
    const trouble = (text) => { say(text); by("explore-body").hidden = true; };
    if (!id) { graph = null; trouble(""); return; }
    if (!by(`graph-${id}`)) { trouble(`This page has no graph ${id}.`); return; }
    say("Opening the graph.");
    let everything;
    let found;
    try {
      [everything, found] = await Promise.all([payloadJson("explorer-about"), payloadJson(`graph-${id}`)]);
    } catch (error) {
      if (turn === opening) trouble(`The graph cannot be opened: ${error.message}. A browser of 2023 or later can.`);
      return;
    }
    if (turn !== opening) return;
    graph = { ...found, id, checked: everything.graphs[id] };
    about = everything.devices[`${graph.document}/${graph.device}`];
    letters = new Map(graph.inputs.letters.map((one, letter) => [one.join(" "), letter]));
    chosen = [...input(0)];
    by("explore-graph").value = id;
    drawInputs();
    const states = by("explore-state");
    const groups = new Map();
    graph.states.forEach((_, state) => {
      if (!groups.has(control(state))) groups.set(control(state), node("optgroup", "", { label: control(state) }));
      groups.get(control(state)).append(node("option", name(state), { value: String(state) }));
    });
    states.replaceChildren(...groups.values());
    states.disabled = false;
    by("explore-body").hidden = false;
    const good = path.findIndex((letter) => !(Number.isInteger(letter) && letter >= 0 && letter < graph.columns.length));
    trail = good < 0 ? path : path.slice(0, good);
    go(trail.length);
    if (good >= 0) say(`The link names an input that this graph does not have; its trail ends before scan ${good + 1}. ${told()}`);
  };

  const follow = async () => {
    const match = /^#explore-([^/]+)\/([\d.]*)$/.exec(decodeURIComponent(location.hash));
    if (!match) return;
    await open(match[1], match[2] === "" ? [] : match[2].split(".").map(Number));
    box.scrollIntoView();
    by("explore-title").focus({ preventScroll: true });
  };

  by("explore-graph").addEventListener("change", (event) => open(event.target.value));
  by("explore-state").addEventListener("change", (event) => {
    trail = shortest(Number(event.target.value));
    go(trail.length);
  });
  by("explore-back").addEventListener("click", () => go(at - 1));
  by("explore-on").addEventListener("click", () => go(at + 1));
  by("explore-reset").addEventListener("click", reset);
  by("explore-form").addEventListener("submit", (event) => {
    event.preventDefault();
    scan(letterOf(chosen));
  });
  box.addEventListener("keydown", (event) => {
    if (!graph || event.target.matches("select, input, textarea") || event.altKey || event.ctrlKey || event.metaKey) return;
    const act = { ArrowLeft: () => go(at - 1), ArrowRight: () => go(at + 1), Home: reset }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
  window.addEventListener("hashchange", follow);
  follow();
})();
