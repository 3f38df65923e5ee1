"use strict";
(() => {
  const [NAME, ID, SCORE, OUTCOME, TOLD, FOLDER, POINTS] = [0, 1, 2, 3, 4, 5, 6];
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);
  const language = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" });
  const folded = (text) => text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
  const rows = data.rows.map((row, place) => ({
    row, place, text: folded([row[NAME], row[ID], row[OUTCOME], row[TOLD]].join("\n")),
  }));
  const columns = [
    { title: "Student", value: (row) => row[NAME] },
    { title: "Id", value: (row) => row[ID] },
    { title: "Score", value: (row) => row[SCORE], number: true },
    { title: "Outcome", value: (row) => row[OUTCOME] },
    { title: "Feedback", value: (row) => row[TOLD], kind: "told" },
    ...data.checks.map((check, n) => ({
      title: check.id.replaceAll("_", " "), value: (row) => row[POINTS][n], number: true, most: check.points,
    })),
  ];
  const state = { words: [], outcome: "", column: 0, down: false, page: 0 };
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
      (!state.outcome || row[OUTCOME] === state.outcome) && state.words.every((word) => text.includes(word)));
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

  function draw() {
    const size = Number(byId("size").value);
    const pages = Math.max(1, Math.ceil(found.length / size));
    const body = document.createElement("tbody");
    body.id = "rows";
    for (const { row } of found.slice(state.page * size, (state.page + 1) * size)) {
      const line = body.insertRow();
      const link = document.createElement("a");
      link.textContent = row[NAME];
      link.href = `./${encodeURIComponent(row[FOLDER])}/${data.page}`;
      link.dir = "auto";
      const first = document.createElement("th");
      first.scope = "row";
      first.append(row[SCORE] === null ? row[NAME] : link);
      line.append(first);
      for (const column of columns.slice(1)) {
        const value = column.value(row);
        cell(line, column.number ? plain(value) : value, column.number ? "number" : column.kind);
      }
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
  }
  byId("search").addEventListener("input", (event) => {
    state.words = folded(event.target.value).split(/\s+/).filter(Boolean);
    choose();
  });
  byId("outcome").addEventListener("change", (event) => { state.outcome = event.target.value; choose(); });
  byId("size").addEventListener("change", () => { state.page = 0; draw(); });
  byId("before").addEventListener("click", () => { state.page -= 1; draw(); });
  byId("after").addEventListener("click", () => { state.page += 1; draw(); });
  document.forms[0].addEventListener("submit", (event) => event.preventDefault());
  draw();
})();
