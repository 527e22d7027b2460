// Wide equations are set smaller, as far as they stay legible; what is wider still scrolls in its
// box, or, on paper, is set as small as it takes.
const SMALLEST = 0.72; // over the usual size, on a screen
const PAPER = 600; // width of an equation beside its number on A4 [px]

function fit() {
  for (const box of document.querySelectorAll("div.math > mjx-container")) {
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

window.addEventListener("load", async () => {
  await window.MathJax?.startup?.promise;
  fit();
  let waiting;
  window.addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(fit, 100);
  });
});
