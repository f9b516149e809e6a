"use strict";
// What every part uses: sources of figures, payload, files to keep, rich tables, deep links, printing.

// A figure shows, when it is clicked or entered with Enter or Space, the file that it comes from and its hash.
(() => {
  let sources, folders;
  const box = document.getElementById("source");
  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  const says = (path) => {
    sources ??= read("sources");
    folders ??= read("folders");
    if (!path) return `all files together: ${Object.keys(sources).length}; SHA-256 of their list ${folders[""]}`;
    if (path in sources) return `${path}: SHA-256 ${sources[path]}`;
    const below = Object.keys(sources).filter((one) => one.startsWith(path)).length;
    return path in folders ? `counted from ${below} files of ${path}: SHA-256 of their list ${folders[path]}` : `${path}: no hash known`;
  };
  const show = (figure) => { box.textContent = says(figure.dataset.source); box.hidden = false; };
  document.addEventListener("click", (event) => {
    const figure = event.target.closest(".figure");
    if (figure) show(figure); else box.hidden = true;
  });
  document.addEventListener("keydown", (event) => {
    if ((event.key === "Enter" || event.key === " ") && event.target.matches(".figure")) { event.preventDefault(); show(event.target); }
    if (event.key === "Escape") box.hidden = true;
  });
})();

// The payload of an id: what only scripts read, as bytes. It is decoded when it is asked for, and once.
const payload = (() => {
  const known = new Map();
  const decode = async (id) => {
    const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  };
  return (id) => {
    if (!known.has(id)) known.set(id, decode(id));
    return known.get(id);
  };
})();
const payloadText = async (id) => new TextDecoder().decode(await payload(id));
const payloadJson = async (id) => JSON.parse(await payloadText(id));

// A file that the page carries is saved under its name.
document.addEventListener("click", async (event) => {
  const button = event.target.closest("button.attachment");
  if (!button) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([await payload(`file-${button.dataset.file}`)]));
  link.download = button.dataset.file;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
});

// Tables of class `rich` can be filtered and sorted once they come into view; until then they are plain tables.
const richTables = (() => {
  let library;
  const load = () => library ??= (async () => {
    const style = document.createElement("style");
    style.textContent = await payloadText("datatables-style");
    document.head.prepend(style);
    const script = document.createElement("script");
    script.textContent = await payloadText("datatables-script");
    document.head.append(script);
  })();
  const made = new Map();
  const enrich = async (table) => {
    if (made.has(table)) return;
    made.set(table, null);
    await load();
    const name = table.caption?.textContent ?? table.id;
    made.set(table, new DataTable(table, {
      paging: false, order: [], autoWidth: false, orderClasses: false,
      layout: { topStart: "search", topEnd: "info", bottomStart: null, bottomEnd: null },
      language: { search: "Filter", searchPlaceholder: "any words of a row", info: "_TOTAL_ rows", infoFiltered: "of _MAX_", infoEmpty: "no row", zeroRecords: "No row has these words." },
      initComplete() { this.api().table().container().querySelector("input[type=search]").setAttribute("aria-label", `Filter ${name}`); },
    }));
  };
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting) { seen.unobserve(entry.target); enrich(entry.target); }
  }, { rootMargin: "300px" });
  for (const table of document.querySelectorAll("table.rich")) seen.observe(table);
  // A filter hides rows; whoever needs all of them (a link, the printer) shows them, and may filter again afterwards.
  const showAll = () => {
    const before = [];
    for (const table of made.values()) if (table?.search()) { before.push([table, table.search()]); table.search("").draw(); }
    return () => { for (const [table, words] of before) table.search(words).draw(); };
  };
  return { enrich, showAll };
})();

// What is wider than its place can be scrolled by keyboard.
(() => {
  const watch = new ResizeObserver((entries) => {
    for (const { target } of entries) if (target.scrollWidth > target.clientWidth) target.tabIndex = 0; else target.removeAttribute("tabindex");
  });
  for (const one of document.querySelectorAll(".wide")) watch.observe(one);
})();

// A link into something closed opens it; a link to a row that a filter hides shows all rows.
const reveal = (id) => {
  if (!id) return null;
  let target = document.getElementById(id);
  for (const one of target?.querySelectorAll(":scope > details.part") ?? []) one.open = true;
  if (!target) { richTables.showAll(); target = document.getElementById(id); }
  target ??= document.getElementById({ explore: "explore", trace: "trace-viewer" }[id.split("-")[0]]);
  if (!target) return null;
  for (let one = target; one; one = one.parentElement) if (one.tagName === "DETAILS") one.open = true;
  return target;
};
(() => {
  const go = () => {
    const target = reveal(decodeURIComponent(location.hash.slice(1)));
    if (!target || !document.getElementById(decodeURIComponent(location.hash.slice(1)))) return;
    target.scrollIntoView();
    if (!target.matches("a, button, input, [tabindex]")) target.setAttribute("tabindex", "-1");
    target.focus({ preventScroll: true });
    document.dispatchEvent(new CustomEvent("revealed", { detail: target }));
  };
  window.addEventListener("hashchange", go);
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#"]');
    if (link && link.hash === location.hash) go();
  });
  reveal(decodeURIComponent(location.hash.slice(1)));
  if (location.hash) requestAnimationFrame(go);
})();

// On paper every row shows and all that is printed is open; the annex is printed, or the review sheet, when a button asks.
(() => {
  let restore = [];
  window.addEventListener("beforeprint", () => {
    restore = [richTables.showAll()];
    const wanted = { all: "details", review: "#review details" }[document.body.dataset.print] ?? "details:not(.annex, .annex *)";
    for (const one of document.querySelectorAll(wanted)) if (!one.open) { one.open = true; restore.push(() => { one.open = false; }); }
  });
  window.addEventListener("afterprint", () => { for (const undo of restore.splice(0)) undo(); delete document.body.dataset.print; });
  document.addEventListener("click", (event) => {
    const button = event.target.closest("button.print");
    if (!button) return;
    if (button.dataset.print) document.body.dataset.print = button.dataset.print;
    window.print();
  });
})();

// The part that is being read is marked in the list of parts.
(() => {
  const links = new Map([...document.querySelectorAll("nav a")].map((link) => [link.hash.slice(1), link]));
  const visible = new Set();
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting) visible.add(entry.target.id); else visible.delete(entry.target.id);
    const first = [...links.keys()].find((id) => visible.has(id));
    for (const [id, link] of links) if (id === first) link.setAttribute("aria-current", "true"); else link.removeAttribute("aria-current");
  }, { rootMargin: "-10% 0px -60% 0px" });
  for (const section of document.querySelectorAll("main > section")) watch.observe(section);
})();
