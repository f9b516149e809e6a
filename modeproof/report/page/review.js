"use strict";
// The review sheet: answers are kept as the file that `modeproof report --review` reads, and read back from it.
(() => {
  const said = document.getElementById("review-said");
  if (!said) return;
  const rows = new Map([...document.querySelectorAll("#review .row")].map((row) => [row.dataset.row, row]));
  const answers = ["accept", "reject", "remark"];
  const field = (id) => document.getElementById(id);
  const say = (text, wrong = false) => { said.textContent = wrong ? `Refused: ${text}` : text; said.classList.toggle("refused", wrong); };
  const chosen = (row) => row.querySelector("input[type=radio]:checked")?.value ?? "";
  const words = (row) => row.querySelector(".said");
  const count = () => {
    const given = [...rows.values()].map(chosen);
    const of = (word) => given.filter((one) => one === word).length;
    say(`${given.length} rows: ${of("accept")} accepted, ${of("reject")} rejected, ${of("remark")} with a remark, ${of("")} open.`);
  };
  // CSV: cells in quotes may hold separators, line ends and doubled quotes.
  const parse = (text) => {
    const head = text.split("\n", 1)[0];
    const parts = (mark) => head.split(mark).length;
    const between = [",", ";", "\t"].reduce((best, mark) => (parts(mark) > parts(best) ? mark : best));
    const lines = [[""]];
    let quoted = false;
    for (let at = 0; at < text.length; at++) {
      const letter = text[at], line = lines.at(-1);
      if (quoted && letter === '"' && text[at + 1] === '"') { line[line.length - 1] += '"'; at++; }
      else if (letter === '"') quoted = !quoted;
      else if (!quoted && letter === between) line.push("");
      else if (!quoted && letter === "\n") lines.push([""]);
      else if (quoted || letter !== "\r") line[line.length - 1] += letter;
    }
    if (quoted) throw new Error("a quote is not closed");
    return lines.filter((line) => line.length > 1 || line[0]);
  };
  const quote = (cell) => (/[",;\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell);
  const safe = (cell) => (/^[=+\-@]/.test(cell) ? `'${cell}` : cell);
  const table = (text) => {
    const [heads, ...lines] = parse(text.replace(/^\ufeff/, ""));
    const at = (name) => heads?.indexOf(name) ?? -1;
    for (const name of ["row", "text", "answer", "words", "name", "day"]) if (at(name) < 0) throw new Error(`no review sheet: it has no column ${name}`);
    return { heads, lines, at };
  };
  const keep = async () => {
    const { heads, lines, at } = table(await payloadText("file-review.csv"));
    for (const line of lines) {
      const row = rows.get(line[at("row")]), answer = chosen(row);
      if (answer === "remark" && !words(row).value.trim()) { words(row).focus(); say(`${row.dataset.row}: a remark without words`, true); return; }
      line[at("answer")] = answer;
      line[at("words")] = safe(words(row).value);
      line[at("name")] = answer ? safe(field("review-name").value || row.dataset.name || "") : "";
      line[at("day")] = answer ? field("review-day").value || row.dataset.day || "" : "";
    }
    const text = [heads, ...lines].map((line) => line.map(quote).join(",")).join("\r\n");
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([`\ufeff${text}\r\n`], { type: "text/csv" }));
    link.download = "review-answered.csv";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  const back = async (file) => {
    const { heads, lines, at } = table(await file.text());
    const found = [], seen = new Set();
    for (const [number, line] of lines.entries()) {
      const id = line[at("row")], row = rows.get(id), answer = (line[at("answer")] ?? "").trim().toLowerCase();
      const place = `line ${number + 2}`;
      if (line.length !== heads.length) throw new Error(`${place} has not as many cells as the first`);
      if (!row) throw new Error(`${place}: this report has no row ${id.slice(0, 80)}`);
      if (seen.has(id)) throw new Error(`${place}: the row ${id} stands twice`);
      seen.add(id);
      if (answer && !answers.includes(answer)) throw new Error(`${place}: ${answer.slice(0, 40)} is no answer`);
      if (answer) found.push([row, line, answer]);
    }
    let old = 0;
    for (const [row, line, answer] of found) {
      if (line[at("text")] !== row.dataset.text) { old++; continue; }
      row.querySelector(`input[value=${answer}]`).checked = true;
      words(row).value = line[at("words")];
      row.dataset.name = line[at("name")];
      row.dataset.day = line[at("day")];
    }
    count();
    if (old) say(`${said.textContent} ${old} answers are to an earlier text and do not count.`);
  };
  field("review-keep").addEventListener("click", keep);
  field("review-file").addEventListener("change", (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (file) back(file).catch((error) => say(`${file.name}: ${error.message}`, true));
  });
  document.getElementById("review").addEventListener("change", (event) => { if (event.target.type === "radio") count(); });
})();
