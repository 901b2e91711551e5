/* Text beside the picture: counts, notes, and the list of pairs. */

const ROWS_MORE = 100;
const panel = { rows: ROWS_MORE, list: pairs };

/* ---- Counts and notes ---- */

function fillHeader() {
    const names = meshes.map((mesh) => baseName(mesh.name));
    const title = isSelf ? `${names[0]} with itself` : `${names[0]} and ${names[1]}`;
    document.title = `Meshes: ${title}`;
    find("title").textContent = title;
    find("said").textContent = data.moving
        ? `Faces that meet, at some time of ${short(data.T)} s` : "Faces that meet";
    show(find("counts"),
        makeCount("pairs", data.count, "pair of faces meets", "pairs of faces meet"),
        makeCount("overlapping", data.overlapping, "overlaps", "overlap"),
        makeCount("touching", data.touching, "touches", "touch"));
}

/* Notes state what the page leaves out. */
function notesOf() {
    const notes = [];
    if (data.count > pairs.length)
        notes.push(`The list has the first ${grouped(pairs.length)} of ${grouped(data.count)} `
            + "pairs; the program tells them all.");
    if (data.as === "tetrahedra")
        notes.push("What was asked are tetrahedra over the faces; what is drawn are the faces.");
    return notes;
}

function fillNotes() {
    show(find("notes"), ...notesOf().map((note) => warning(note)));
}

/* ---- Facts ---- */

/* The earliest and latest contact over all listed pairs. */
function timesOfAll() {
    let first = Infinity, last = -Infinity;
    for (const { times } of pairs) {
        first = Math.min(first, times[0]);
        last = Math.max(last, times[1]);
    }
    return [first, last];
}

function fillFacts() {
    const facts = meshes.flatMap((mesh) => fact(meshLetter(mesh.index),
        make("i", { class: `swatch mesh-${mesh.index}` }), ` ${mesh.name}: `
        + `${grouped(mesh.met)} of ${counted(mesh.faces, "face meets", "faces meet")}`));
    if (isSelf)
        facts.push(...fact("beside", `${counted(data.sharing_edge, "pair shares", "pairs share")} `
            + `an edge, ${grouped(data.sharing_vertex)} a vertex, and nothing else: not counted `
            + "above"));
    if (data.moving && pairs.length > 0)
        facts.push(...fact("contact", `${intervalText(...timesOfAll())} s, of a window of `
            + `${short(data.T)} s`));
    show(find("facts"), ...facts);
}

function fillLegend() {
    show(find("stage-legend"), swatch("met-overlapping", "overlaps"),
        swatch("met-touching", "touches"),
        isMoving ? swatch("met-later", "meets at another time") : null,
        ...meshes.map(({ index }) => swatch(`mesh-${index}`, `the rest of ${meshLetter(index)}`)));
}

/* ---- The list ---- */

/* The pairs that match the filter: number of a face of either mesh, and verdict. */
function filtered() {
    const number = /^\s*\d+\s*$/.test(find("filter").value) ? Number(find("filter").value) : null;
    const verdict = Number(find("verdict").value);
    return pairs.filter((pair) => (number === null || pair.numbers.includes(number))
        && (verdict === 0 || pair.verdict === verdict));
}

function pairName({ numbers }) {
    return `${meshLetter(0)} ${numbers[0]} – ${meshLetter(1)} ${numbers[1]}`;
}

function rowOfPair(pair) {
    const { index, verdict, times } = pair, isChosen = pair === chosen.pair;
    const pressed = { class: "pair", "aria-pressed": String(isChosen) };
    return make("tr", { class: isChosen ? "chosen" : null, "data-pair": index },
        make("td", {}, make("button", pressed, pairName(pair))),
        make("td", {}, verdictChip(verdict)),
        times && make("td", { title: `${intervalExact(...times)} s` }, intervalText(...times)));
}

function listText(count) {
    const all = counted(pairs.length, "pair", "pairs");
    if (pairs.length === 0)
        return "No faces meet.";
    return count === pairs.length ? all : `${grouped(count)} of ${all}`;
}

function fillList() {
    const { list } = panel, rows = list.slice(0, panel.rows), more = list.length - rows.length;
    show(find("list"), ...rows.map(rowOfPair));
    find("times-head").hidden = !data.moving;
    find("list-said").textContent = listText(list.length);
    find("more").hidden = more === 0;
    find("more").textContent = `show ${Math.min(more, ROWS_MORE)} more of ${grouped(more)}`;
}

function applyFilter() {
    panel.list = filtered();
    panel.rows = ROWS_MORE;
    fillList();
}

/* Scrolls the list to the row of the chosen pair, if it is listed. The page does not scroll. */
function showChosenRow() {
    const at = panel.list.indexOf(chosen.pair);
    panel.rows = Math.max(panel.rows, at + 1);
    fillList();
    const row = find("list").querySelector(".chosen"), frame = find("list-frame");
    if (!row)
        return;
    const head = frame.querySelector("thead").offsetHeight, top = row.offsetTop - head;
    const bottom = row.offsetTop + row.offsetHeight - frame.clientHeight;
    frame.scrollTop = clamp(frame.scrollTop, bottom, top);
}

/* ---- Times of contact ---- */

/* The contact of the chosen pair; otherwise the times at which any pair is in contact. */
function contactTimes() {
    if (chosen.pair)
        return [chosen.pair.times];
    const joined = [];
    for (const [first, last] of pairs.map((pair) => pair.times).sort((a, b) => a[0] - b[0])) {
        const before = joined[joined.length - 1];
        if (before && first <= before[1])
            before[1] = Math.max(before[1], last);
        else
            joined.push([first, last]);
    }
    return joined;
}

const BANDS_MAX = 500;

function drawBands() {
    find("window").hidden = !isMoving;
    if (!isMoving)
        return;
    const kind = chosen.pair ? VERDICTS[chosen.pair.verdict] : "overlapping";
    show(find("bands"), ...contactTimes().slice(0, BANDS_MAX).map((times) =>
        makeBand(kind, times, data.T, `in contact ${intervalText(...times)} s`)));
}
