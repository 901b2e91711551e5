/* The table of pairs: their answers at this moment, and a lane of verdicts over time. */

const table = { shown: [], limit: 100, sort: null, down: false, step: -1, time: 0, cells: [] };
const hasContacts = steps.some((step) => step.T > 0 && step.pairs.some((pair) => nowOf(pair).contact));
const hasGaps = steps.some((step) => step.pairs.some((pair) => nowOf(pair).gap));
/* title: of an answer, its name among the facts; value: what is sorted by. */
const columns = [
    { title: "pair", width: "20%", value: (row) => row.name },
    { title: "verdict", width: "20%", value: (row, answer) => answer ? -answer.verdict : 1 },
    { title: "contact", width: "25%", value: (row, answer) => answer?.contact ? answer.step.t + answer.contact[0] : Infinity },
    { title: "gap", width: "17%", value: (row, answer) => answer?.gap?.[0] ?? Infinity },
    { title: "over time", width: "18%", lane: true, value: (row) => segmentsOf(row).find(([, , verdict]) => verdict >= TOUCHING)?.[0] ?? Infinity },
].filter(({ title, lane }) => (title !== "contact" || hasContacts) && (title !== "gap" || hasGaps) && (!lane || steps.length > 1 || hasContacts));
const collator = new Intl.Collator(undefined, { numeric: true });

function currentAnswer(row) {
    const pair = pairNow(row, Math.max(table.step, 0));
    return pair && nowOf(pair);
}

/* ---- Which rows ---- */

function isFound(row) {
    const words = one("filter").value.toLowerCase().split(/\s+/).filter(Boolean), name = row.name.toLowerCase();
    return words.every((word) => name.includes(word)) && (!one("contacts").checked || row.worst >= TOUCHING);
}

/* At first: those that differ, then by the strongest verdict, in the order of the steps. */
function compareRows(a, b) {
    if (table.sort === null)
        return b.differs - a.differs || b.worst - a.worst || a.index - b.index;
    const [x, y] = [a, b].map((row) => columns[table.sort].value(row, currentAnswer(row)));
    const order = typeof x === "string" ? collator.compare(x, y) : x === y ? 0 : x < y ? -1 : 1;
    return (table.down ? -order : order) || a.index - b.index;
}

function chooseRows() {
    const found = rows.filter(isFound).sort(compareRows);
    table.shown = found.slice(0, table.limit);
    one("more").hidden = found.length <= table.limit;
    one("more").textContent = `show ${Math.min(100, found.length - table.limit)} more`;
    one("rows-said").textContent = found.length === rows.length ? `${rows.length} pairs` : `${found.length} of ${rows.length} pairs`;
    one("pairs").replaceChildren(...table.shown.map(makeRow));
    table.cells = [...one("pairs").rows].map((tr) => [...tr.cells]);
    fillRows();
    drawLanes();
}

function makeRow(row) {
    const tr = document.createElement("tr");
    tr.dataset.row = row.index;
    tr.className = row === stage.row ? "chosen" : "";
    for (const { lane } of columns) {
        const td = tr.insertCell();
        if (lane) {
            td.className = "lane";
            td.append(one("lane").content.cloneNode(true));
        }
    }
    tr.cells[0].textContent = row.name;
    tr.cells[0].classList.toggle("different", row.differs);
    return tr;
}

/* Writes the answers of this moment where they have changed. */
function fillRows() {
    table.shown.forEach((row, n) => {
        const answer = currentAnswer(row), facts = answer ? factsOf(answer) : {};
        columns.forEach(({ title, lane }, k) => {
            const cell = table.cells[n][k], text = facts[title] ?? "";
            if (k > 0 && !lane && cell.textContent !== text)
                cell.textContent = cell.title = text;
        });
        const name = `verdict v${answer?.verdict ?? 0}`;
        if (table.cells[n][1].className !== name)
            table.cells[n][1].className = name;
    });
}

/* Reads all sizes before it draws; otherwise the browser would lay out the table anew for each lane. */
function drawLanes() {
    const canvases = table.cells.map((cells) => cells[columns.length - 1].querySelector("canvas"));
    canvases.map((canvas) => canvas && sizeOf(canvas)).forEach((size, n) => size && drawLane(canvases[n], [table.shown[n]], size));
}

function drawHeads() {
    one("heads").replaceChildren(...columns.map((column, k) => {
        const th = document.createElement("th");
        th.style.width = column.width;
        th.textContent = column.title + (table.sort === k ? table.down ? " ▾" : " ▴" : "");
        th.addEventListener("click", () => {
            table.down = table.sort === k && !table.down;
            table.sort = k;
            drawHeads();
            chooseRows();
        });
        return th;
    }));
}

/* ---- The chosen pair, and the step ---- */

function choose(row) {
    stage.row = row === stage.row ? null : row;
    [...one("pairs").rows].forEach((tr) => tr.classList.toggle("chosen", stage.row !== null && Number(tr.dataset.row) === stage.row.index));
    drawGap(stage.row);
    table.step = -1;
    show();
}

function addFact(list, name, text, differs = false) {
    if (!text)
        return;
    const dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = name;
    dd.textContent = text;
    dd.classList.toggle("different", differs);
    list.append(dt, dd);
}

function factsOf(answer) {
    if (!answer)
        return { verdict: "no answer" };
    const facts = { verdict: answer.error ?? verdictNames[answer.verdict] };
    if (answer.contact)
        facts.contact = `${clockInterval(answer.step, ...answer.contact)} s`;
    const dim = (answer.box?.length ?? 0) / 2;
    for (let axis = 0; axis < dim; axis++)
        facts[`box ${"xyz"[axis]}`] = interval(answer.box[axis], answer.box[dim + axis]);
    if (answer.point)
        facts.point = `(${answer.point.slice(1).map((x) => short(x)).join(", ")}) at ${clockInterval(answer.step, answer.point[0], answer.point[0])} s`;
    if (answer.gap)
        facts.gap = interval(...answer.gap.slice(0, 2));
    return facts;
}

/* [fact, name, number] of each number of an answer; fact: the line that shows the number rounded. Times count from the
 * start of the window, since clock times are rounded. */
function numbersOf(answer) {
    const { contact, box, point, gap } = answer ?? {}, axis = (i, dim) => "xyz"[i % dim];
    const dim = (box?.length ?? 0) / 2, points = ((gap?.length ?? 2) - 3) / 2;
    return [
        ...(contact ?? []).map((number, i) => ["contact", `${["first", "last"][i]} contact in the window`, number]),
        ...(box ?? []).map((number, i) => [`box ${axis(i, dim)}`, `box ${i < dim ? "min" : "max"} ${axis(i, dim)}`, number]),
        ...(point ?? []).map((number, i) => ["point", i ? `point ${axis(i - 1, 3)}` : "point, time in the window", number]),
        ...(gap ?? []).map((number, i) => ["gap", ["gap, lower bound", "gap, upper bound", "gap, time in the window"][i]
            ?? `witness point of the ${i - 3 < points ? "first" : "second"}, ${axis(i - 3, points)}`, number]),
    ];
}

/* Facts of two answers, side by side where they differ; numbers that differ beyond the digits of a fact
 * have all digits. */
function addComparison(list, pair) {
    const [before, after] = [isDifferent(pair) ? pair[2] : nowOf(pair), nowOf(pair)];
    const then = factsOf(before), now = factsOf(after), differ = Object.keys({ ...then, ...now }).filter((name) => then[name] !== now[name]);
    const both = (a, b) => `${data.sides[0]}: ${a ?? "none"} · ${data.sides[1]}: ${b ?? "none"}`;
    const exact = new Map(numbersOf(before).map(([, name, number]) => [name, number]));
    for (const name of Object.keys({ ...then, ...now }))
        addFact(list, name, differ.includes(name) ? both(then[name], now[name]) : now[name], differ.includes(name));
    const beyond = numbersOf(after).filter(([fact, name, number]) => !differ.includes(fact) && exact.get(name) !== number);
    for (const [, name, number] of beyond)
        addFact(list, name, both(exact.get(name) ?? "∞", number ?? "∞"), true);
    if (isDifferent(pair) && differ.length + beyond.length === 0)
        addFact(list, "gap, direction or points", "differs", true);
}

function resultText({ error, method, compute_ns: ns, counts }) {
    return error ?? `${counts.map((count, k) => count ? `${count} ${verdictNames[k + 1]}` : "").filter(Boolean).join(", ") || "no pairs"}${method ? `, by ${method}` : ""}, ${short(ns / 1000)} µs`;
}

function drawDetail() {
    const step = steps[table.step], list = document.createElement("dl");
    if (!step)
        return;
    const pair = stage.row && pairNow(stage.row, table.step);
    addFact(list, "pair", stage.row?.name);
    if (pair)
        addComparison(list, pair);
    addFact(list, "label", step.label);
    if (step.outcome)
        addFact(list, "query", `event ${step.event} at byte ${step.offset} of ${step.log}: ${step.outcome}`, step.differs);
    step.result?.forEach((result, side) => result && addFact(list, data.sides[side], resultText(result)));
    addFact(list, "note", step.note);
    addFact(list, "left out", step.more && `${step.more} more pairs of this step`);
    step.bodies.forEach(([id, shape, name], index) => typeof shape === "string" && addFact(list, "not drawn", `${name || `body ${id || `#${index}`}`}: ${shape}`));
    one("detail").replaceChildren(list);
}
