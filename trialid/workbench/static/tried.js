/* A manoeuvre that was tried, drawn: every motion in its range, and the track to scale. */

const SVG = "http://www.w3.org/2000/svg";

export function pictures(made) {
  const figure = document.createElement("figure");
  figure.className = "tried";
  figure.append(...made.panels.map((panel) => drawn(panel, made)));
  if (made.track) figure.append(track(made.track, made.width));
  const words = document.createElement("figcaption");
  words.textContent = "Lines: as fitted. Shaded, and boxes on the track: where she is likely to be, 95\u2009%.";
  figure.append(words);
  return figure;
}

function drawn(panel, made) {
  const unit = panel.unit ? ", " + panel.unit : "";
  const picture = view(made.width + 60, made.height + 34, panel.title + " over " + made.seconds);
  const inside = element("g", { transform: "translate(50 18)" });
  if (panel.band) inside.append(element("polygon", { class: "band", points: panel.band }));
  inside.append(
    element("polyline", { class: "line", points: panel.line }),
    element("rect", { class: "frame", width: made.width, height: made.height }),
    text(0, -5, panel.title + unit, "start"),
    text(-5, 10, panel.high, "end"),
    text(-5, made.height, panel.low, "end"),
    text(0, made.height + 13, "0 s", "start"),
    text(made.width, made.height + 13, made.seconds, "end"),
  );
  picture.append(inside);
  return picture;
}

function track(plan, width) {
  const picture = view(width + 60, plan.height + 6, "Track, " + plan.scale_words + " to the bar");
  picture.append(...plan.boxes.map((points) => element("polygon", { class: "band", points })));
  picture.append(element("polyline", { class: "line", points: plan.line }));
  plan.boxes.forEach((points, k) => {
    const [x, y] = points.split(" ")[2].split(",").map(Number);
    if (k % 2) picture.append(text(x + 3, y - 3, plan.times[k], "start"));
  });
  const bar = element("g", { transform: "translate(8 " + (plan.height - 6) + ")" });
  bar.append(
    element("path", { class: "frame", d: "M0,-4 V4 M0,0 H" + plan.scale + " M" + plan.scale + ",-4 V4" }),
    text(plan.scale + 6, 4, plan.scale_words + ", the approach course upwards", "start"),
  );
  picture.append(bar);
  return picture;
}

function view(width, height, label) {
  return element("svg", { viewBox: "0 0 " + width + " " + height, role: "img", "aria-label": label });
}

function text(x, y, words, anchor) {
  const made = element("text", { x, y, "text-anchor": anchor });
  made.textContent = words;
  return made;
}

function element(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}
