"use strict";
(() => {
  const [NAME, ID, SCORE, OUTCOME, TOLD, FOLDER, POINTS, GROUP] = [0, 1, 2, 3, 4, 5, 6, 7];
  const [RECORDINGS, SUBMITTED, ATTEMPTS, FAULT, CHANGES] = [8, 9, 10, 11, 12];
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);
  const language = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" });
  const folded = (text) => text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
  const rows = data.rows.map((row, place) => ({
    row, place, text: folded([row[NAME], row[ID], row[OUTCOME], row[TOLD]].join("\n")),
  }));
  const any = (test) => data.rows.some(test);
  const columns = [
    { title: "Student", value: (row) => row[NAME] },
    ...(any((row) => row[ID]) ? [{ title: "Id", value: (row) => row[ID], kind: "id" }] : []),
    { title: "Score", value: (row) => row[SCORE], number: true },
    { title: "Outcome", value: (row) => row[OUTCOME] },
    { title: "Feedback", value: (row) => row[TOLD], kind: "told" },
    ...(any((row) => row[SUBMITTED]) ? [{ title: "Submitted", value: (row) => row[SUBMITTED], kind: "when" }] : []),
    ...(any((row) => row[ATTEMPTS] > 1) ? [{ title: "Attempts", value: (row) => row[ATTEMPTS], number: true }] : []),
    ...data.checks.map((check, n) => ({
      title: check.id.replaceAll("_", " "), value: (row) => row[POINTS][n], number: true, most: check.points,
    })),
  ];
  const state = { words: [], outcome: "", group: "", fault: null, column: 0, down: false, page: 0, open: new Set() };
  let found = rows;

  function plain(value) {
    return value === null || value === undefined ? "" : String(+Number(value).toFixed(2));
  }

  function compare(one, other) {
    const column = columns[state.column];
    const [a, b] = [column.value(one.row), column.value(other.row)];
    if (column.number) {
      if ((a === null) !== (b === null)) return a === null ? 1 : -1;
      return (state.down ? b - a : a - b) || one.place - other.place;
    }
    return (state.down ? language.compare(b, a) : language.compare(a, b)) || one.place - other.place;
  }

  function choose() {
    found = rows.filter(({ row, text }) =>
      (!state.outcome || row[OUTCOME] === state.outcome)
      && (!state.group || row[GROUP] === Number(state.group))
      && (state.fault === null || row[FAULT] === state.fault) && state.words.every((word) => text.includes(word)));
    if (state.column || state.down) found.sort(compare);
    state.page = 0;
    draw();
  }

  function cell(line, text, kind) {
    const made = line.insertCell();
    made.textContent = text;
    if (kind) made.className = kind;
    return made;
  }

  function path(row, name) {
    const [file, part] = name.split("#");
    return `./${`${row[FOLDER]}/${file}`.split("/").map(encodeURIComponent).join("/")}${part ? `#${part}` : ""}`;
  }

  function made(tag, text, more = {}) {
    return Object.assign(document.createElement(tag), { textContent: text }, more);
  }

  function quoted(text) {
    return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  }

  function shell(text) {
    return `'${text.replaceAll("'", "'\\''")}'`;
  }

  // What there is of a student, in one place: pages, recordings, and the line that changes the points by hand.
  function details(body, row) {
    const line = body.insertRow();
    line.className = "details";
    const place = line.insertCell();
    place.colSpan = columns.length;
    const links = made("p", "");
    const link = (text, name) => links.append(made("a", text, { href: path(row, name) }), " ");
    link("Report", data.page);
    if (data.page.endsWith(".html")) {
      if (row[RECORDINGS].length) link("Log", `${data.page}#log-heading`);
      link("JSON", "report.json");
    }
    for (const name of row[RECORDINGS]) link(name, name);
    place.append(links);
    for (const change of row[CHANGES]) place.append(made("p", change));
    const commands = row[RECORDINGS].map((name) => `course show ${shell(`${row[FOLDER]}/${name}`)}`);
    if (commands.length) place.append(made("p", "In a terminal, in this folder, the run:"), made("pre", commands.join("\n")));
    place.append(made("p", "To change the points, a line of overrides.csv (student,exercise,check,points,comment):"));
    const example = data.checks.find((check, n) => row[POINTS][n] !== check.points) || data.checks[0];
    place.append(made("pre", [row[NAME], data.exercise, example.id, plain(example.points), "why"].map(quoted).join(",")));
  }

  function draw() {
    const size = Number(byId("size").value);
    const pages = Math.max(1, Math.ceil(found.length / size));
    const body = document.createElement("tbody");
    body.id = "rows";
    for (const { row } of found.slice(state.page * size, (state.page + 1) * size)) {
      const line = body.insertRow();
      const link = made("a", row[NAME], { href: path(row, data.page), dir: "auto" });
      const first = made("th", "", { scope: "row" });
      const graded = row[OUTCOME] !== "infra" && row[OUTCOME] !== "pending";
      if (graded) {
        const open = state.open.has(row);
        const more = made("button", "", { type: "button", className: "more" });
        more.setAttribute("aria-expanded", String(open));
        more.setAttribute("aria-label", `Everything on ${row[NAME]}`);
        more.addEventListener("click", () => {
          if (!state.open.delete(row)) state.open.add(row);
          draw();
        });
        first.append(more);
      }
      first.append(graded ? link : row[NAME]);
      line.append(first);
      for (const column of columns.slice(1)) {
        const value = column.value(row);
        cell(line, column.number ? plain(value) : value, column.number ? "number" : column.kind);
      }
      if (state.open.has(row)) details(body, row);
    }
    byId("rows").replaceWith(body);
    byId("count").textContent = found.length === rows.length ? "" : `${found.length} of ${rows.length} submissions`;
    byId("page").textContent = `Page ${state.page + 1} of ${pages}`;
    byId("before").disabled = state.page === 0;
    byId("after").disabled = state.page >= pages - 1;
  }

  columns.forEach((column, n) => {
    const head = document.createElement("th");
    const button = document.createElement("button");
    head.scope = "col";
    if (column.number) head.className = "number";
    if (column.most !== undefined && data.checks.length > 6) head.classList.add("upright");
    button.type = "button";
    button.textContent = column.most === undefined ? column.title : `${column.title} (${plain(column.most)})`;
    button.addEventListener("click", () => {
      state.down = state.column === n && !state.down;
      state.column = n;
      for (const each of byId("head").children) each.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", state.down ? "descending" : "ascending");
      choose();
    });
    head.append(button);
    byId("head").append(head);
  });
  const counts = new Map();
  for (const { row } of rows) counts.set(row[OUTCOME], (counts.get(row[OUTCOME]) || 0) + 1);
  for (const [outcome, count] of [...counts].sort()) {
    byId("outcome").append(new Option(`${outcome} (${count})`, outcome));
  }
  const scores = rows.map(({ row }) => row[SCORE]).filter((score) => score !== null).sort((a, b) => a - b);
  if (scores.length) {
    const full = scores.filter((score) => score >= data.most).length;
    const median = (scores[(scores.length - 1) >> 1] + scores[scores.length >> 1]) / 2;
    byId("summary").textContent += `, ${full} with full marks, median ${plain(median)} of ${plain(data.most)}`;
    const parts = Array(10).fill(0);
    for (const score of scores) parts[Math.min(9, Math.floor((score / data.most) * 10))] += 1;
    parts.forEach((count, n) => {
      const [low, high] = [n, n + 1].map((part) => plain((data.most * part) / 10));
      const bar = made("div", "", { className: "bar", title: `${low} to ${high} points: ${count}` });
      const box = made("div", "", { className: "box" });
      box.style.height = `${(4 * count) / Math.max(...parts)}rem`;
      bar.append(made("span", String(count)), box, made("span", n === 9 ? `${low}-${high}` : low));
      byId("distribution").append(bar);
    });
    const shares = data.checks.map((check, n) => {
      const points = rows.map(({ row }) => row[POINTS][n]).filter((value) => value !== null && value !== undefined);
      return { id: check.id, share: points.reduce((sum, value) => sum + value, 0) / (check.points * points.length || 1) };
    }).sort((a, b) => a.share - b.share);
    byId("checks").textContent = `Hardest checks: ${shares.slice(0, 3)
      .map(({ id, share }) => `${id.replaceAll("_", " ")} (${Math.round(100 * share)} % of its points)`).join(", ")}`;
  }
  const times = rows.map(({ row }) => row[SUBMITTED]).filter(Boolean).sort();
  const attempts = rows.reduce((sum, { row }) => sum + row[ATTEMPTS], 0);
  byId("times").textContent = [
    times.length ? `Handed in from ${times[0]} to ${times[times.length - 1]}` : "",
    attempts > rows.length ? `${plain(attempts / rows.length)} attempts each` : "",
  ].filter(Boolean).join("; ");
  data.faults.forEach(([example, count], n) => {
    const item = made("li", "");
    const button = made("button", `${count} students`, { type: "button" });
    button.addEventListener("click", () => {
      state.fault = state.fault === n ? null : n;
      for (const each of byId("faults").querySelectorAll("button")) each.setAttribute("aria-pressed", "false");
      button.setAttribute("aria-pressed", String(state.fault === n));
      choose();
    });
    const first = data.rows.find((row) => row[FAULT] === n);
    item.append(button, " ", example, " (", made("a", first[NAME], { href: path(first, data.page), dir: "auto" }), ")");
    byId("faults").append(item);
  });
  byId("alike").hidden = !data.faults.length;
  byId("search").addEventListener("input", (event) => {
    state.words = folded(event.target.value).split(/\s+/).filter(Boolean);
    choose();
  });
  byId("outcome").addEventListener("change", (event) => { state.outcome = event.target.value; choose(); });
  const tried = data.groups.reduce((sum, [, count]) => sum + count, 0);
  data.groups.forEach(([change, count], n) => {
    byId("group").append(new Option(`${count} of ${tried}: ${change}`, String(n)));
  });
  byId("groups").hidden = !tried;
  byId("group").addEventListener("change", (event) => { state.group = event.target.value; choose(); });
  byId("size").addEventListener("change", () => { state.page = 0; draw(); });
  byId("before").addEventListener("click", () => { state.page -= 1; draw(); });
  byId("after").addEventListener("click", () => { state.page += 1; draw(); });
  document.forms[0].addEventListener("submit", (event) => event.preventDefault());
  draw();
})();
