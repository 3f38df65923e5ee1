"use strict";
// Plays the run of a report: moves the shapes of the drawing, the scan, the path and the arrow to a moment of the run.
for (const figure of document.querySelectorAll("figure.run")) {
  const data = JSON.parse(figure.querySelector("script").textContent);
  const find = (name) => figure.querySelector(name);
  const polygons = figure.querySelectorAll(".moving polygon");
  const scans = figure.querySelectorAll("path.scan");
  const path = find("polyline.path"), heading = find("path.heading");
  const button = find("button.play"), slider = find("input"), rate = find("select"), told = find("output");
  const px = (x) => ((x - data.left) * data.scale).toFixed(1), py = (y) => ((data.top - y) * data.scale).toFixed(1);
  let now = data.end, playing = false, last = 0;

  // The convex hull of points: Andrew's monotone chain.
  function hull(points) {
    points.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const half = (ordered) => {
      const line = [];
      for (const p of ordered) {
        while (line.length > 1) {
          const [a, b] = line.slice(-2);
          if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
          line.pop();
        }
        line.push(p);
      }
      return line.slice(0, -1);
    };
    return [...half(points), ...half([...points].reverse())];
  }

  function outline([link, corners], frame) {
    const rows = data.links[link], at = rows.length > 8 ? 8 * frame : 0, m = rows.slice(at, at + 8), points = [];
    for (let i = 0; i < corners.length; i += 3) {
      const [x, y, z] = corners.slice(i, i + 3);
      points.push([m[0] * x + m[1] * y + m[2] * z + m[6], m[3] * x + m[4] * y + m[5] * z + m[7]]);
    }
    return hull(points).map((p) => px(p[0]) + "," + py(p[1])).join(" ");
  }

  function show() {
    const frame = Math.round((now / data.end) * (data.count - 1));
    data.shapes.forEach((shape, i) => polygons[i].setAttribute("points", outline(shape, frame)));
    data.scans.forEach((scan, i) => {
      let n = 0;
      while (n + 1 < scan.at.length && scan.at[n + 1] <= now) n += 1;
      const d = scan.dots[n];
      let dots = "";
      for (let j = 0; j < d.length; j += 2) dots += "M" + d[j] + " " + d[j + 1] + "h0";
      scans[i].setAttribute("d", dots);
    });
    let words = now.toFixed(2) + " s";
    if (data.robot.length) {
      const [x, y, yaw] = data.robot.slice(3 * frame, 3 * frame + 3), corners = [];
      for (let i = 0; i <= frame; i += 1) corners.push(px(data.robot[3 * i]) + "," + py(data.robot[3 * i + 1]));
      path.setAttribute("points", corners.join(" "));
      const size = Math.max(0.35 * data.scale, 14), dx = size * Math.cos(yaw), dy = -size * Math.sin(yaw);
      const from = [Number(px(x)), Number(py(y))], tip = (from[0] + dx) + " " + (from[1] + dy);
      const side = (s) => (from[0] + 0.7 * dx + s * dy) + " " + (from[1] + 0.7 * dy - s * dx);
      heading?.setAttribute("d", `M${from[0]} ${from[1]}L${tip}M${side(0.25)}L${tip}L${side(-0.25)}`);
      const degrees = Math.round((yaw * 180) / Math.PI) || 0;
      words += `: x = ${x.toFixed(2)} m, y = ${y.toFixed(2)} m, heading ${degrees}\u00b0`;
    }
    told.textContent = words;
    slider.value = now;
    slider.setAttribute("aria-valuetext", words);
  }

  function tick(time) {
    if (!playing) return;
    now = Math.min(now + (Math.min(time - last, 250) / 1000) * Number(rate.value), data.end);
    last = time;
    show();
    if (now >= data.end) play(false);
    else requestAnimationFrame(tick);
  }

  function play(start) {
    playing = start;
    button.textContent = start ? "Pause" : "Play";
    if (!start) return;
    if (now >= data.end) now = 0;
    last = performance.now();
    requestAnimationFrame(tick);
  }

  function jump(to) {
    play(false);
    now = Math.min(Math.max(to, 0), data.end);
    show();
  }

  button.addEventListener("click", () => play(!playing));
  slider.addEventListener("input", () => jump(Number(slider.value)));
  for (const moment of figure.querySelectorAll("button[value]")) {
    moment.addEventListener("click", () => jump(Number(moment.value)));
  }
  find(".controls").hidden = false;
  const start = /^#(play$|t=)([0-9.]*)$/.exec(location.hash);
  if (start) figure.scrollIntoView({ block: "center" });
  if (start && start[2]) jump(Number(start[2]));
  else if (start) play(true);
  else slider.value = now;
}
