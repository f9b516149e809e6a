"use strict";
// A figure shows, when it is clicked, entered or focused with Enter, the file that it comes from and its hash.
(() => {
  const sources = JSON.parse(document.getElementById("sources").textContent);
  const box = document.getElementById("source");
  const show = (figure) => {
    const path = figure.dataset.source;
    box.textContent = path ? `${path}  SHA-256 ${sources[path] ?? "unknown"}` : `all evidence: ${Object.keys(sources).length} files`;
    box.hidden = false;
  };
  document.addEventListener("click", (event) => {
    const figure = event.target.closest(".figure");
    if (figure) show(figure); else box.hidden = true;
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.matches(".figure")) show(event.target);
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
const payloadJson = async (id) => JSON.parse(new TextDecoder().decode(await payload(id)));

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
