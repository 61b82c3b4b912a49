// Plots, drawn by Observable Plot as SVG that follows the page's colours.

const MUTED = "var(--muted)";

/** More slopes than this say nothing. */
const MOST_GUIDES = 8;

/** Error bars and bands need numbers above zero on logarithmic axes. */
const positive = (value) => value > 0 && Number.isFinite(value);

function base(element, options) {
  const width = Math.max(300, element.clientWidth);
  return {
    width, height: Math.round(Math.min(360, Math.max(250, 0.62 * width))), marginLeft: 58, marginRight: 16, marginTop: 26, marginBottom: 40,
    style: {background: "none", fontSize: "12px", fontFamily: "inherit", overflow: "visible"}, ...options,
  };
}

/** Labels for a logarithmic axis: short, without loss. */
const short = (value) => (value >= 0.01 && value < 10000 ? String(Number(value.toPrecision(3))) : value.toExponential(0).replace("e", "·10^").replace(/\^([+-]?)(\d+)/, (_, sign, n) => superscript((sign === "-" ? "-" : "") + n)).replace(/^1·/, ""));
const superscript = (text) => text.replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));

const label = (point) => `${point.name}\n${digits(point.time)} ms\nerror ${digits(point.error)}`;

/** Ticks of a logarithmic axis, few enough to read: whole decades where there are many, else 1, 2, 5, and more of them on short axes. `room` is 1 for
 * an axis of ordinary length, less for a shorter one. */
function ticks(values, room) {
  const low = Math.min(...values), high = Math.max(...values), decades = Math.log10(high / low) / room;
  const steps = decades > 3 ? [1] : decades > 1.2 ? [1, 2, 5] : decades > 0.5 ? [1, 1.5, 2, 3, 5, 7] : [1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9];
  const list = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e++) for (const step of steps) list.push(Number(`${step}e${e}`));
  return list;
}

/** Room around the values, so that no point sits on an axis. */
function domain(values) {
  const low = Math.min(...values), high = Math.max(...values), room = Math.max((high / low) ** 0.06, 1.15);
  return [low / room, high * room];
}

/** Room of an axis across an element. */
const across = (element) => Math.min(1, element.clientWidth / 420);

function logAxis(values, name, room = 1) {
  const reach = domain(values);
  return {type: "log", domain: reach, ticks: ticks(values, room).filter((t) => t >= reach[0] && t <= reach[1]), tickFormat: short, label: name, grid: true};
}

/** Error against time with its band, the line that independent samples follow, and the error to be reached, if one is. */
function errorAgainstTime(element, points, names, reached) {
  const usable = points.filter((p) => positive(p.time) && positive(p.error));
  if (!usable.length) return nothing(element, "No error above zero to plot.");
  const low = (p) => (positive(p.low) ? p.low : p.error), high = (p) => (positive(p.high) ? p.high : p.error);
  const times = usable.map((p) => p.time), x = logAxis(times.length > 1 && Math.max(...times) > Math.min(...times) ? times : times.flatMap((t) => [t / 2, t * 2]), names.x, across(element));
  const y = logAxis(usable.flatMap((p) => [low(p), high(p)]), names.y);
  const series = [...new Map(usable.map((p) => [p.graph, usable.filter((q) => q.graph === p.graph)])).values()];
  const guides = series.length > MOST_GUIDES ? [] : series.flatMap((s) => slope(s[0], x.domain, s[0].graph));
  const lines = series.filter((s) => s.length > 1).flat(), single = usable.filter((p) => !lines.includes(p));
  show(element, Plot.plot(base(element, {
    x, y,
    marks: [
      Plot.line(guides, {x: "time", y: "error", z: "graph", stroke: MUTED, strokeDasharray: "2 4", strokeOpacity: 0.8, clip: true}),
      ...(reached ? [Plot.ruleY([reached], {stroke: MUTED, clip: true})] : []),
      Plot.areaY(lines, {x: "time", y1: low, y2: high, z: "graph", fill: "color", fillOpacity: 0.16, clip: true}),
      Plot.line(lines, {x: "time", y: "error", z: "graph", stroke: "color", strokeWidth: 2, clip: true}),
      Plot.ruleX(single, {x: "time", y1: low, y2: high, stroke: "color", strokeWidth: 2}),
      Plot.dot(usable, {x: "time", y: "error", fill: "color", r: 4, stroke: "var(--page)", strokeWidth: 1.2}),
      ...nameMarks(single, x.domain),
      Plot.tip(usable, Plot.pointer({x: "time", y: "error", title: label, fill: "var(--card)", stroke: "var(--line)"})),
    ],
  })));
}

/** error ∝ time^(−1/2) through a point, across the plot. */
function slope(point, [from, to], graph) {
  return [from, to].map((time) => ({time, error: point.error * Math.sqrt(point.time / time), graph}));
}

/** Every graph at every budget, and the front of those that no other beats in both. */
function pareto(element, points, names) {
  const usable = points.filter((p) => positive(p.time) && positive(p.error));
  if (!usable.length) return nothing(element, "No error above zero to plot.");
  const low = (p) => (positive(p.low) ? p.low : p.error), high = (p) => (positive(p.high) ? p.high : p.error);
  const front = usable.filter((p) => !usable.some((q) => q !== p && q.time <= p.time && q.error <= p.error)).sort((a, b) => a.time - b.time);
  const times = usable.flatMap((p) => [p.time_low ?? p.time, p.time_high ?? p.time]);
  const x = logAxis(times.every((t) => t === times[0]) ? [times[0] / 2, times[0] * 2] : times, names.x, across(element));
  show(element, Plot.plot(base(element, {
    x, y: logAxis(usable.flatMap((p) => [low(p), high(p)]), names.y),
    marks: [
      Plot.line(front, {x: "time", y: "error", curve: "step-after", stroke: MUTED, strokeWidth: 1.5}),
      Plot.ruleX(usable, {x: "time", y1: low, y2: high, stroke: "color", strokeWidth: 1.5}),
      Plot.ruleY(usable, {y: "error", x1: (p) => p.time_low ?? p.time, x2: (p) => p.time_high ?? p.time, stroke: "color", strokeWidth: 1.5}),
      Plot.dot(usable, {x: "time", y: "error", fill: (p) => (front.includes(p) ? p.color : "var(--page)"), stroke: "color", strokeWidth: 2, r: 5}),
      ...nameMarks(firsts(usable), x.domain),
      Plot.tip(usable, Plot.pointer({x: "time", y: "error", title: label, fill: "var(--card)", stroke: "var(--line)"})),
    ],
  })));
}

/** Names beside points, towards the middle of the plot; what would lie over another is left out, the legend and the pointer still tell. */
function nameMarks(points, [from, to]) {
  const far = (p) => p.time > from ** 0.4 * to ** 0.6;
  const taken = [];
  return [false, true].map((right) => Plot.text(points.filter((p) => far(p) === right), apart(taken, right, {x: "time", y: "error", text: "name",
    dx: right ? -9 : 9, textAnchor: right ? "end" : "start", fill: "currentColor", stroke: "var(--card)", strokeWidth: 4})));
}

/** Text within the plot, where no text of `taken` is yet. */
function apart(taken, right, options) {
  const [letter, line] = [6, 13];
  const initializer = (data, facets, {x, y, text}, scales, {width}) => {
    const free = (i) => {
      const [at, top, wide] = [scales.x(x.value[i]), scales.y(y.value[i]), 9 + letter * String(text.value[i]).length];
      const box = right ? [at - wide, at, top] : [at, at + wide, top];
      const clear = box[0] >= 0 && box[1] <= width && taken.every(([left, end, other]) => box[1] < left || end < box[0] || Math.abs(other - top) >= line);
      if (clear) taken.push(box);
      return clear;
    };
    return {data, facets: facets.map((facet) => facet.filter(free))};
  };
  return {...options, initializer};
}

/** The first point of every graph. */
const firsts = (points) => points.filter((p, i) => points.findIndex((q) => q.graph === p.graph) === i);

/** Error of every frame. */
function errorOfFrames(element, points, names) {
  const usable = points.filter((p) => positive(p.error));
  if (!usable.length) return nothing(element, "No error above zero to plot.");
  const low = (p) => (positive(p.low) ? p.low : p.error), high = (p) => (positive(p.high) ? p.high : p.error);
  show(element, Plot.plot(base(element, {
    x: {label: names.x, grid: true}, y: logAxis(usable.flatMap((p) => [low(p), high(p)]), names.y),
    marks: [
      Plot.areaY(usable, {x: "frame", y1: low, y2: high, z: "graph", fill: "color", fillOpacity: 0.16}),
      Plot.line(usable, {x: "frame", y: "error", z: "graph", stroke: "color", strokeWidth: 2}),
      Plot.tip(usable, Plot.pointer({x: "frame", y: "error", title: label, fill: "var(--card)", stroke: "var(--line)"})),
    ],
  })));
}

/** When each graph reaches the same error, a line a graph. */
function timeToError(element, points) {
  const x = logAxis(points.flatMap((p) => [p.low, p.high, p.time * 1.05]), "time (ms) →", across(element));
  show(element, Plot.plot(base(element, {
    x, y: {domain: points.map((p) => p.name), label: null, axis: null}, height: 90 + 44 * points.length, marginLeft: 16,
    marks: [
      Plot.ruleY(points, {y: "name", x1: "low", x2: "high", stroke: "color", strokeWidth: 2}),
      Plot.dot(points, {y: "name", x: "time", fill: (p) => (p.at_once ? "var(--page)" : p.color), stroke: "color", strokeWidth: 2, r: 5}),
      Plot.text(points, {y: "name", x: "time", text: "name", dy: -14, fill: "currentColor", stroke: "var(--card)", strokeWidth: 4,
        textAnchor: "middle"}),
    ],
  })));
}

/** Correlation against distance in frames or pixels. */
function correlation(element, points, names) {
  show(element, Plot.plot(base(element, {
    x: {label: names.x, ticks: Math.min(8, new Set(points.map((p) => p.lag)).size)}, y: {label: names.y, grid: true},
    marks: [
      Plot.ruleY([0], {stroke: MUTED}),
      Plot.line(points, {x: "lag", y: "value", z: "graph", stroke: "color", strokeWidth: 2}),
      Plot.dot(points, {x: "lag", y: "value", fill: "color", r: 3.5}),
    ],
  })));
}

function show(element, plot) {
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", element.dataset.title);
  element.replaceChildren(plot);
}

function nothing(element, words) {
  element.textContent = words;
}
