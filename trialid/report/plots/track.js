/* The track beside the panels: the stretch of time that they show fills its frame, the rest is faint. */

const LEAST = 50;                // times closer than the whole, at most: a ship's length is to be seen in it
const ROOM = 0.12;               // of the stretch's size, about it
const BAR = 0.3;                 // of the frame, that the scale may take

/* Draws the stretch of a track from a time to another; all: the whole of it. */
export function followTrack(svg, from, to, all) {
  const way = svg.querySelector(".way");
  way.querySelectorAll(".part").forEach((part) => part.remove());
  const kept = all ? [] : [...way.querySelectorAll("polyline")].flatMap((line) => drawPart(line, from, to));
  way.classList.toggle("narrowed", kept.length > 0);
  way.querySelectorAll("[data-at]").forEach((each) => {
    each.classList.toggle("elsewhere", kept.length > 0 && (each.dataset.at < from || each.dataset.at > to));
  });
  frame(svg, way, kept);
}

/* What of a line lies between two times, as a line of its own; its points. */
function drawPart(line, from, to) {
  const times = line.dataset.times.split(",").map(Number);
  const points = line.getAttribute("points").split(" ").map((pair) => pair.split(",").map(Number));
  const inner = points.filter((point, k) => times[k] > from && times[k] < to);
  const kept = [pointAt(times, points, from), ...inner, pointAt(times, points, to)].filter(Boolean);
  if (kept.length < 2) return [];
  const part = line.cloneNode();
  part.classList.add("part");
  part.setAttribute("points", kept.map((pair) => pair.join(",")).join(" "));
  line.after(part);
  return kept;
}

/* Where a line is at a time; null before its first and after its last. */
function pointAt(times, points, t) {
  const k = times.findIndex((each) => each >= t);
  if (k < 0 || (k === 0 && times[0] > t)) return null;
  if (k === 0) return points[0];
  const share = (t - times[k - 1]) / (times[k] - times[k - 1]);
  return [0, 1].map((c) => points[k - 1][c] + share * (points[k][c] - points[k - 1][c]));
}

/* The frame about points, of the shape that the whole has, and the scale that goes with it. */
function frame(svg, way, points) {
  const [, , width, height] = way.dataset.whole.split(" ").map(Number);
  const ends = [0, 1].map((c) => [Math.min(...points.map((p) => p[c])), Math.max(...points.map((p) => p[c]))]);
  const [wide, tall] = ends.map(([low, high]) => (1 + 2 * ROOM) * (high - low));
  const share = points.length ? Math.min(Math.max(wide / width, tall / height, 1 / LEAST), 1) : 1;
  const [x, y] = share < 1 ? ends.map(([low, high], c) => (low + high - share * [width, height][c]) / 2) : [0, 0];
  way.setAttribute("viewBox", [x, y, share * width, share * height].join(" "));
  way.style.setProperty("--closer", share);
  drawScale(svg, width, Number(svg.dataset.scale) / share);
}

function drawScale(svg, width, perMetre) {
  const ten = 10 ** Math.floor(Math.log10((BAR * width) / perMetre));
  const metres = [5, 2, 1].map((each) => each * ten).find((each) => each * perMetre <= BAR * width * 1.000001);
  const bar = (metres * perMetre).toFixed(1);
  svg.querySelector("path.scale").setAttribute("d", "M0,-3 V3 M0,0 H" + bar + " M" + bar + ",-3 V3");
  const words = svg.querySelector(".scale-words");
  words.setAttribute("x", Number(bar) + 6);
  words.textContent = Number(metres.toPrecision(3)) + " m";
}
