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
