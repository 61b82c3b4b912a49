// What brings the page to life: words, theme, keys, and the parts above.

const signed = (value, places) => `${value < 0 ? "−" : "+"}${Math.abs(value).toFixed(places)}`;
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

/** Four significant digits; small and large numbers with an exponent. */
function digits(value) {
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  return size && (size < 1e-3 || size >= 1e5) ? value.toExponential(2).replace("-", "−") : String(Number(value.toPrecision(4)));
}

/** A colour map as CSS. */
function gradient(colors, reversed) {
  const stops = Array.from({length: 17}, (_, i) => Math.round((i * 255) / 16)).map((i) => `rgb(${[0, 1, 2].map((c) => colors[3 * i + c])})`);
  return `linear-gradient(to right, ${(reversed ? stops.reverse() : stops).join(", ")})`;
}

const data = JSON.parse(document.getElementById("data").textContent);
const maps = {magma: bytesOf(data.magma), difference: bytesOf(data.difference)};
const color = (graph) => `var(--series-${graph % 8})`;

const viewers = data.scenes.filter((scene) => scene.pictures.length).map((scene) => new Viewer(document.getElementById(`viewer-${scene.id}`), scene, maps));

/** The square root of an error, so that N samples lie on N^(−1/2). */
function chartPoints(points, error) {
  return points.filter((p) => p[error]).map((p) => {
    const [value, low, high] = p[error].map((v) => (v > 0 ? Math.sqrt(v) : NaN));
    return {...p, name: data.graphs[p.graph], color: color(p.graph), error: value, low, high};
  });
}

const KINDS = {
  time: (element, scene, error) => errorAgainstTime(element, chartPoints(scene.curve, error), {x: "time (ms) →", y: `↑ ${NAMES[error]}`}, error === "mse" && scene.reached ? Math.sqrt(scene.reached) : null),
  frame: (element, scene, error) => errorOfFrames(element, chartPoints(scene.curve, error), {x: "frame →", y: `↑ ${NAMES[error]}`}),
  pareto: (element, scene, error) => pareto(element, chartPoints(scene.cells, error), {x: "time (ms) →", y: `↑ ${NAMES[error]}`}),
  reach: (element, scene) => timeToError(element, scene.reach.map((p) => ({...p, name: data.graphs[p.graph], color: color(p.graph)}))),
  temporal: (element, scene) => correlation(element, colored(scene.temporal), {x: "frames apart →", y: "↑ correlation"}),
  spatial: (element, scene) => correlation(element, colored(scene.spatial), {x: "pixels apart →", y: "↑ correlation"}),
};
const NAMES = {rel_mse: "√relMSE", mse: "√MSE"};
const colored = (points) => points.map((p) => ({...p, color: color(p.graph)}));

function drawCharts() {
  const error = document.querySelector('input[name="error"]:checked')?.value ?? "rel_mse";
  for (const element of document.querySelectorAll(".chart")) {
    const scene = data.scenes.find((s) => s.id === element.dataset.scene);
    if (element.clientWidth) KINDS[element.dataset.kind](element, scene, scene.black ? "mse" : error);
  }
}

drawCharts();
for (const input of document.querySelectorAll('input[name="error"]')) input.addEventListener("change", drawCharts);
for (const details of document.querySelectorAll("details")) details.addEventListener("toggle", drawCharts);
let width = window.innerWidth;
window.addEventListener("resize", () => {
  if (window.innerWidth === width) return;
  width = window.innerWidth;
  drawCharts();
});

/** Keys go to the viewer that was touched last, or else to the one nearest to the middle of the window. */
let touched = null;
for (const viewer of viewers) viewer.root.addEventListener("pointerdown", () => (touched = viewer), true);
function current() {
  const distance = (viewer) => {
    const box = viewer.stage.getBoundingClientRect();
    return Math.abs((box.top + box.bottom) / 2 - window.innerHeight / 2);
  };
  const visible = (viewer) => {
    const box = viewer.stage.getBoundingClientRect();
    return box.bottom > 0 && box.top < window.innerHeight;
  };
  const seen = viewers.filter(visible);
  return seen.includes(touched) ? touched : seen.sort((a, b) => distance(a) - distance(b))[0];
}
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("select, textarea, input:not([type=range])")) return;
  if (event.target.matches("input[type=range]") && event.key.startsWith("Arrow")) return;
  if (current()?.key(event)) event.preventDefault();
});

/** Light, dark, or what the system says. */
document.getElementById("theme").addEventListener("click", (event) => {
  const root = document.documentElement, dark = getComputedStyle(root).getPropertyValue("--is-dark").trim() === "1";
  root.dataset.theme = dark ? "light" : "dark";
  event.currentTarget.setAttribute("aria-pressed", !dark);
});

for (const button of document.querySelectorAll("button[data-copy]")) {
  button.addEventListener("click", async () => {
    const text = document.getElementById(button.dataset.copy).textContent;
    await navigator.clipboard?.writeText(text);
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = "Copy"), 1500);
  });
}
document.documentElement.dataset.ready = "true";
