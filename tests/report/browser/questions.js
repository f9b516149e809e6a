// What is asked of any page. Each question gives a list of what is wrong, in words.
window.questions = (() => {
  const seen = (one) => one.checkVisibility();
  const named = (one) => `${one.tagName} ${one.id || one.closest("[id]")?.id}`;
  const start = (one) => one.textContent.trim().replace(/\s+/g, " ").slice(0, 60);
  return {
    // What is wider than its place, or leaves the page at the right.
    cut() {
      const inner = [...document.querySelectorAll("main .wide, main pre, main table, main dl, main ul, main ol, main p, main h2, main h3, main h4")]
        .filter((one) => seen(one) && one.clientWidth > 0 && one.scrollWidth > one.clientWidth + 1)
        .map((one) => `${named(one)}: ${one.scrollWidth} wide in ${one.clientWidth}: ${start(one)}`);
      const outer = [...document.querySelectorAll("main *")]
        .filter((one) => seen(one) && !one.parentElement.closest("svg") && one.getBoundingClientRect().right > innerWidth + 1)
        .map((one) => `${named(one)}: ends at ${Math.round(one.getBoundingClientRect().right)} of ${innerWidth}: ${start(one)}`);
      return [...inner, ...outer];
    },
    // What has the colour of a verdict, but no sign, or no word for those who do not see the sign.
    wordless() {
      return [...document.querySelectorAll(".good, .bad, .hole")]
        .filter((one) => !one.closest("svg"))
        .filter((one) => {
          const text = (one.closest(".word") ?? one).textContent;
          return !/[✓✗?]/.test(text) || !/[A-Za-z]{2}/.test(text + (one.getAttribute("aria-label") ?? ""));
        })
        .map((one) => one.outerHTML.slice(0, 160));
    },
    // Rows of tables that do not show, and what is still closed.
    hidden() {
      return [...document.querySelectorAll("main table tbody tr, main details > :not(summary)")]
        .filter((one) => !one.closest("[hidden], .explorer, .screen, #trace-viewer, noscript") && !seen(one))
        .map((one) => `${named(one)}: ${start(one)}`);
    },
    // Links within the page that lead nowhere; those with a path are read by scripts.
    lost() {
      const links = new Set([...document.querySelectorAll('a[href^="#"]')].map((one) => one.getAttribute("href")));
      return [...links].filter((href) => !href.includes("/") && !document.getElementById(decodeURIComponent(href.slice(1))));
    },
    // What breaks a rule of axe-core, with the first places. Rows of a table are alike: of each table the first are asked,
    // and the others are out of the page meanwhile.
    async inaccessible(rules, rows = 12) {
      const out = [...document.querySelectorAll("tbody")].map((body) => [body, [...body.rows].slice(rows)]);
      for (const [, rest] of out) for (const row of rest) row.remove();
      const found = await axe.run(document, { runOnly: { type: "tag", values: rules }, resultTypes: ["violations"] });
      for (const [body, rest] of out) body.append(...rest);
      return found.violations.map((one) => {
        const places = one.nodes.slice(0, 3).map((node) => `${node.html.slice(0, 160)} ${node.any[0]?.message ?? ""}`);
        return `${one.id}: ${one.help}: ${one.nodes.length} times: ${places.join(" | ")}`;
      });
    },
  };
})();
