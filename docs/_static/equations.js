// Wide equations are set smaller, as far as they stay legible. One that is wider still is broken where
// its parts and its equals signs are; what is wider even so scrolls in its box, or, on paper, is set as
// small as it takes.
const SMALLEST = 0.72; // over the usual size, on a screen
const PAPER = 600; // width of an equation beside its number on A4 [px]
const equations = () => [...document.querySelectorAll("div.math > mjx-container")];

function fit() {
  for (const box of equations()) {
    const style = box.style;
    const usual = Number(box.dataset.usual ?? (parseFloat(style.fontSize) || 100));
    box.dataset.usual = usual;
    style.fontSize = `${usual}%`;
    const width = box.scrollWidth;
    style.setProperty("--on-paper", `${usual * Math.min(1, PAPER / width)}%`);
    const size = box.clientWidth / width;
    if (size < 1 && box.clientWidth) {
      style.fontSize = `${usual * Math.max(SMALLEST, 0.995 * size)}%`;
    }
  }
}

// the parts of a formula between marks that stand in no braces, brackets or environments
function parts(formula, mark) {
  const found = [""];
  let depth = 0;
  for (const token of formula.match(/\\(?:begin|end)\{\w+\*?\}|\\[a-zA-Z]+|\\.|[^\\]/gs) ?? []) {
    if (/^\\(begin\{.*|left)$|^[{[(]$/s.test(token)) depth += 1;
    if (/^\\(end\{.*|right)$|^[}\])]$/s.test(token)) depth -= 1;
    if (depth === 0 && token === mark) found.push("");
    else found[found.length - 1] += token;
  }
  return found;
}

const aligned = (rows) => `\\begin{aligned}${rows.join("\\\\")}\\end{aligned}`;

// a formula in more and shorter lines: of one line at its parts and equals signs, of aligned columns
// with each pair of columns below the one before it; null where there is nothing to be broken at
function broken(formula) {
  const whole = /^\s*\\begin\{split\}(.*)\\end\{split\}\s*$/s.exec(formula)?.[1] ?? formula;
  const columns = /^\s*\\begin\{aligned\}((?:(?!\\begin\{aligned\}).)*)\\end\{aligned\}\s*$/s.exec(whole)?.[1];
  if (columns) {
    const rows = parts(columns, "\\\\").flatMap((row) => {
      const cells = parts(row.replace(/^\s*\[\d+pt\]/, ""), "&");
      return cells.flatMap((cell, k) => (k % 2 ? [] : [`${cell}&${cells[k + 1] ?? ""}`]));
    });
    return aligned(rows.filter((row) => row.trim() !== "&"));
  }
  if (parts(whole, "\\\\").length > 1 || parts(whole, "&").length > 1) return null;
  const rows = [];
  for (const part of parts(whole, "\\qquad").flatMap((one) => parts(one, "\\quad"))) {
    const [first, ...sides] = parts(part, "=");
    rows.push(sides.length ? `${first}&=${sides[0]}` : `&${first}`);
    rows.push(...sides.slice(1).map((one) => `&=${one}`));
  }
  return rows.length > 1 ? aligned(rows) : null;
}

async function breakWide() {
  const changed = [];
  for (const box of equations().filter((one) => one.scrollWidth > one.clientWidth + 1)) {
    const place = box.parentElement;
    const [item] = MathJax.startup.document.getMathItemsWithin([place]);
    const formula = item && broken(item.math);
    if (formula) {
      MathJax.typesetClear([place]);
      box.replaceWith(`\\[${formula}\\]`);
      changed.push(place);
    }
  }
  if (changed.length) {
    await MathJax.typesetPromise(changed);
    fit();
  }
}

window.addEventListener("load", async () => {
  await window.MathJax?.startup?.promise;
  fit();
  await breakWide();
  document.documentElement.dataset.equations = "set";
  let waiting;
  window.addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(fit, 100);
  });
});
