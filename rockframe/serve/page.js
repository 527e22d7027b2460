"use strict";
// without this script the page works by its button; with it, every change runs immediately
const form = document.querySelector("form"), outcome = document.getElementById("outcome");
let waiting = 0, asked = 0;

function show() {
  const pulse = form.dataset.pulses.split(" ").includes(form.elements.motion.value);
  for (const group of form.querySelectorAll("[data-of]")) {
    const name = group.dataset.of;
    group.hidden = name === "pulse" ? !pulse : name !== form.elements.base.value;
  }
}

async function run() {
  const query = new URLSearchParams(new FormData(form)), number = ++asked;
  outcome.setAttribute("aria-busy", "true");
  let text;
  try {
    text = await (await fetch(`/outcome?${query}`)).text();
  } catch {
    text = '<div class="verdict doubt" role="alert"><strong>No answer</strong>'
      + "The server has ended or cannot be reached; start it again by: rockframe serve</div>";
  }
  if (number !== asked) return; // there is a newer change
  outcome.innerHTML = text;
  outcome.setAttribute("aria-busy", "false");
  history.replaceState(null, "", `/?${query}`);
}

form.addEventListener("input", event => {
  const from = event.target;
  if (from.type === "range") form.elements[from.dataset.for].value = from.value;
  if (from.type === "number") form.querySelector(`[data-for="${from.name}"]`).value = from.value;
  show();
  clearTimeout(waiting);
  waiting = setTimeout(run, 350);
});
form.addEventListener("submit", event => { event.preventDefault(); clearTimeout(waiting); run(); });
