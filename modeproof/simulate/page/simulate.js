// What Python in the page needs of the browser. Brython asks for the script's address before it begins.
var __BRYTHON__ = { brython_path: location.href.slice(0, location.href.lastIndexOf("/") + 1) };
const rawLines = (text) => text.split("\n").filter((line) => line.trim());
async function linesOf(file) {
  const packed = file.name.endsWith(".gz");
  const stream = packed ? file.stream().pipeThrough(new DecompressionStream("gzip")) : file.stream();
  return rawLines(await new Response(stream).text());
}
function readLines(file, done, failed) {
  linesOf(file).then(done, (error) => failed(String(error && error.message || error)));
}
function saveText(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/jsonl" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
// Without the event that a changed address fires: what it carries stands there already.
function setAddress(hash) {
  history.replaceState(null, "", hash);
}
function digestOf(text, done, failed) {
  if (!window.crypto || !crypto.subtle) return failed("this browser computes no SHA-256 for a file");
  crypto.subtle.digest("SHA-256", new TextEncoder().encode(text)).then((bytes) =>
    done([...new Uint8Array(bytes)].map((byte) => byte.toString(16).padStart(2, "0")).join("")), (error) => failed(String(error)));
}
