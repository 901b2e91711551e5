/* Text beside the picture: header, list of differences, tables of the chosen query. */

const PAIRS_FIRST = 30, PAIRS_MORE = 200, DIFFERENCES_FIRST = 50, DIFFERENCES_MORE = 500;
const FRAMES_FIRST = 200;
const panel = { pairs: PAIRS_FIRST, differences: DIFFERENCES_FIRST };

const SHAPES = { 1: ["parallelogram", "cuboid"], 2: ["triangle", "tetrahedron"], 3: ["", "face"],
    4: ["rectangle", "box"] };

function shapeName({ dim, frames }) {
    return frames.length === 1 ? SHAPES[frames[0][0]]?.[dim - 2] ?? "frame"
        : `${frames.length} frames`;
}

/* ---- Header ---- */

function fillCounts() {
    const total = data.count.reduce((sum, count) => sum + count, 0);
    const different = makeCount("different", data.count[DIFFERENT], "different");
    if (data.count[DIFFERENT] > 0)
        different.prepend(make("i", { "aria-hidden": "true" }, "≠"));
    show(find("counts"), makeCount("", total, "query", "queries"),
        makeCount("same", data.count[SAME], "same"), different,
        ...[BUSY, UNKNOWN, UNDEFINED, UNRECORDED]
            .map((is) => makeCount("", data.count[is], OUTCOMES[is])));
}

/* What the page leaves out, and how to see it. */
function leftOutNote() {
    const count = data.left_out.reduce((sum, of) => sum + of, 0);
    if (count === 0)
        return null;
    const seconds = data.left_span.map((utime) => (Number(utime) - Number(data.begin)) / 1e6);
    const differences = data.left_out[DIFFERENT];
    const kept = differing.length === 0 ? "" : ` Differences were kept longer: ${differences === 0
        ? "all of them are here." : `${grouped(differences)} are left out.`}`;
    return warning(
        make("b", {}, `${counted(count, "query is", "queries are")} counted, but not shown`),
        `, from ${timeText(seconds[0])} to ${timeText(seconds[1])} s.${kept} Another page, of a `
            + "part of the log, shows them: ",
        make("code", {}, "fmb replay --from ... --to ... --html FILE"), ".");
}

function fillHeader() {
    const [first, last] = data.span, total = data.count.reduce((sum, count) => sum + count, 0);
    document.title = `Replay: ${data.title}`;
    show(find("title"), make("span", { class: "dim" }, "Replay "), data.title);
    find("said").textContent = total === 0 ? "No query was replayed."
        : total === 1 ? dateText(first)
            : `${durationText((Number(last) - Number(first)) / 1e6)} from ${dateText(first)}; `
                + `times below count from the beginning of the log, ${dateText(data.begin)}`;
    fillCounts();
    show(find("notes"), leftOutNote());
}

function fillLegends() {
    show(find("legend"), swatch("overlapping", "overlapping"), swatch("touching", "touching"),
        swatch("separated", "separated"), swatch("none", "no verdict"),
        differing.length === 0 ? null
            : make("span", { class: "key" }, make("i", { class: "flag-key" }, "≠"), "differs"));
    show(find("stage-legend"), swatch("box", "intersection"),
        differing.length === 0 ? null : swatch("box-then", "intersection then, where it differs"),
        make("span", { class: "key" }, make("i", { class: "arrow-key" }, "→"), "motion"),
        swatch("ghost", "end of the window"),
        data.events.some((event) => event.want & WANT_GAP || event.margin)
            ? swatch("gap", "least distance") : null);
}

/* ---- Differences ---- */

function wordsOf([what, then, now]) {
    return make("span", { class: "change" }, make("span", { class: "what" }, what), " ",
        make("span", { class: "then" }, then), " → ", make("b", {}, now));
}

/* The differences of an event in a few lines: those of the whole, and of its first pairs. */
function changesOf(event) {
    const lines = wholeDifferences(event).map((found) => ["query", found]);
    for (const pair of pairsOf(event))
        if (pair.differs)
            for (const found of sideDifferences(pair.then, pair.now))
                lines.push([pair.ids.map(bodyName).join(" – "), found]);
    return lines;
}

const CHANGES_SHOWN = 3;

function makeDifference(event) {
    const changes = changesOf(event), more = changes.length - CHANGES_SHOWN;
    const names = event.frames.slice(0, 2).map((frame) => bodyName(String(frame[0]))).join(" – ");
    const subject = event.kind === KIND_PAIR ? names
        : counted(event.frames.length, "body", "bodies");
    return make("li", {}, make("button", {
        class: "difference", "data-at": event.at, onclick: () => choose(event.at, null),
    }, make("span", { class: "line" }, make("i", { class: "flag-key" }, "≠"),
        make("b", {}, `${timeText(event.seconds)} s`), make("span", {}, subject),
        make("span", { class: "dim" }, `query ${event.n}`)),
        ...changes.slice(0, CHANGES_SHOWN).map(([of, found]) => make("span", { class: "line" },
            event.kind === KIND_PAIR ? null : make("span", { class: "of" }, of), wordsOf(found))),
        more > 0 ? make("span", { class: "line dim" }, `and ${grouped(more)} more`) : null,
        changes.length > 0 ? null
            : make("span", { class: "line dim" }, "in what this page does not show")));
}

function fillDifferences() {
    const list = find("difference-list"), more = differing.length - panel.differences;
    find("differences").hidden = differing.length === 0;
    find("top").classList.toggle("alone", differing.length === 0);
    find("differences-title").textContent = counted(differing.length, "difference", "differences");
    show(list, ...differing.slice(0, panel.differences).map(makeDifference));
    const button = find("more-differences");
    button.hidden = more <= 0;
    button.textContent = `show ${grouped(Math.min(more, DIFFERENCES_MORE))} more`;
    markDifference();
}

/* Scrolls the list, not the page. */
function markDifference() {
    const list = find("difference-list");
    for (const button of list.querySelectorAll("button")) {
        const isChosen = Number(button.dataset.at) === chosen.at;
        button.classList.toggle("chosen", isChosen);
        if (isChosen) {
            const low = button.offsetTop - list.offsetTop, high = low + button.offsetHeight;
            if (low < list.scrollTop || high > list.scrollTop + list.clientHeight)
                list.scrollTop = low - list.clientHeight / 3;
        }
    }
}

/* ---- The chosen query ---- */

function kindText(event) {
    const frames = counted(event.frames.length + (event.more_frames ?? 0), "body", "bodies");
    return {
        [KIND_PAIR]: "one pair", [KIND_LISTED]: `a scene of ${frames}, pairs as listed`,
        [KIND_ALL]: `a scene of ${frames}, all pairs`,
        [KIND_ACROSS]: `a scene of ${frames}, the first ${grouped(event.split)} against the others`,
    }[event.kind] ?? `a scene of ${frames}`;
}

function wantText({ want, margin }) {
    const names = [[WANT_BOX, "boxes"], [WANT_TIMES, "intervals"],
        [WANT_CERTIFICATE, "a certificate"], [WANT_GAP, "gaps"]];
    return ["verdicts", ...names.filter(([bit]) => want & bit).map(([, name]) => name),
        ...(margin ? [`what is nearer than ${short(margin)}`] : [])].join(", ");
}

function verdictCounts(result) {
    return [OVERLAPPING, TOUCHING, SEPARATED, 0].filter((verdict) => result.count[verdict] > 0)
        .map((verdict) => `${grouped(result.count[verdict])} ${VERDICTS[verdict]}`)
        .join(", ") || "no pair";
}

/* side: of the pair, if the query is a pair query. */
function resultText(result, side) {
    if (!result)
        return "none";
    if (result.status !== 0)
        return `${result.says}${result.detail ? `: ${result.detail}` : ""}`;
    const said = result.count ? verdictCounts(result) : verdictName(verdictOf(side ?? null));
    return `${said}; ${result.method}, ${costText(result.ns)}`;
}

function fillFacts(event) {
    const window = event.T === null ? "of a length that is not finite" : `0 .. ${short(event.T)} s`;
    const log = data.logs.length > 1 ? fact("log", data.logs[event.log]) : [];
    show(find("event-facts"), make("dl", {}, ...log,
        ...fact("at", `${timeText(event.seconds)} s, ${dateText(event.t)}, byte `
            + grouped(event.o)),
        ...fact("query", `${kindText(event)}; ${wantText(event)}; window ${window}`),
        ...fact("then", resultText(event.then, stage.pairs[0]?.then)),
        ...fact("now", resultText(event.now, stage.pairs[0]?.now))));
}

function fillHead(event) {
    const verdict = worstOf(event);
    show(find("event-head"), make("h2", {}, `Query ${event.n}`), verdictChip(verdict),
        make("span", {
            class: `outcome ${event.is === DIFFERENT ? "different" : ""}`,
            title: OUTCOME_TEXT[event.is],
        }, event.is === DIFFERENT ? "≠ different" : OUTCOMES[event.is]));
}

function makeTable(kind, names, rowElements) {
    const head = make("tr", {}, ...names.map((name) => make("th", {}, name)));
    return make("div", { class: "scroll" }, make("table", { class: kind },
        make("thead", {}, head), make("tbody", {}, ...rowElements)));
}

function fillEventDifferences(event) {
    if (event.is !== DIFFERENT) {
        show(find("event-differences"),
            event.is === SAME ? null : make("p", { class: "dim" }, OUTCOME_TEXT[event.is]));
        return;
    }
    const changes = changesOf(event), shown = changes.slice(0, 20);
    const cells = ([of, [what, then, now]]) => make("tr", {}, make("td", {}, of),
        make("td", {}, what), make("td", { class: "then" }, then),
        make("td", {}, make("b", {}, now)));
    show(find("event-differences"), shown.length === 0
        ? make("p", {}, "The results differ in what this page does not show.")
        : makeTable("changes", ["", "differs in", "then", "now"], shown.map(cells)),
        changes.length === shown.length ? null
            : make("p", { class: "dim" }, `and ${grouped(changes.length - shown.length)} more`));
}

/* ---- The pairs ---- */

/* One line if then and now are equal, otherwise two. */
function twice(then, now, differs) {
    if (!differs || then === now)
        return [now];
    if (then === "–")
        return [make("b", {}, now)];
    if (now === "–")
        return [make("span", { class: "then" }, `then ${then}`)];
    return [make("span", { class: "then", title: "then" }, then), make("br"),
        make("b", { title: "now" }, now)];
}

/* The texts of two intervals. One or both may be missing. */
function bothTexts(intervals) {
    return intervals[0] && intervals[1] ? intervalTexts(...intervals)
        : intervals.map((of) => of ? intervalText(...of) : "–");
}

function timesCell(pair) {
    const sides = [timesOf(pair.then), timesOf(pair.now)], texts = bothTexts(sides);
    const title = sides[1] ? `${intervalExact(...sides[1])} s` : null;
    return make("td", { class: "number", title }, ...twice(...texts, pair.differs));
}

/* One line for each axis. */
function boxCell(pair) {
    const boxes = [boxOf(pair.then), boxOf(pair.now)];
    const dim = (boxes[0] ?? boxes[1] ?? [[]])[0].length;
    const lines = [...Array(dim).keys()].map((axis) => {
        const ends = boxes.map((box) => box && axis < box[0].length
            ? [box[0][axis], box[1][axis]] : null);
        return make("div", { class: "axis", title: ends[1] ? intervalExact(...ends[1]) : null },
            make("span", { class: "dim" }, "xyz"[axis]),
            make("span", {}, ...twice(...bothTexts(ends), pair.differs)));
    });
    return make("td", { class: "number" }, ...(dim ? lines : ["–"]));
}

function gapCell(pair) {
    const gaps = [gapOf(pair.then), gapOf(pair.now)];
    return make("td", { class: "number", title: gaps[1] ? intervalExact(...gaps[1]) : null },
        ...twice(...gaps.map(gapText), pair.differs));
}

/* A pair that was not answered then is not compared. */
function verdictsOf(pair) {
    const { then } = stage.event, now = verdictOf(pair.now);
    return then && then.status === 0 ? verdictChips(verdictOf(pair.then), now) : [verdictChip(now)];
}

function makePairRow(pair, has) {
    const name = pair.ids.map(bodyName).join(" – "), isChosen = chosen.pair === pair.index;
    const button = make("button", {
        class: "pair", "aria-pressed": String(isChosen), title: "show this pair in the scene",
        onclick: () => choosePair(isChosen ? -1 : pair.index),
    }, pair.differs ? make("i", { class: "flag-key" }, "≠") : null, name);
    return make("tr", { class: isChosen ? "chosen" : "", "data-pair": pair.index },
        make("td", {}, button), make("td", {}, ...verdictsOf(pair)),
        has.times ? timesCell(pair) : null, has.gaps ? gapCell(pair) : null, has.boxes ? boxCell(pair) : null);
}

function dimNote(text) {
    return make("p", { class: "dim" }, text);
}

function pairNotes(event, hidden) {
    const notes = [];
    if (hidden > 0)
        notes.push(make("button", {
            onclick: () => {
                panel.pairs += PAIRS_MORE;
                fillPairs(event);
            },
        }, `show ${grouped(Math.min(hidden, PAIRS_MORE))} more`));
    if (event.more)
        notes.push(dimNote(`${counted(event.more, "answer more is", "answers more are")} not on `
            + "this page. Pairs that differ come first, then those that meet."));
    const answer = answerOf(event);
    if (answer && event.kind !== KIND_PAIR && (event.first > 0 || answer.end < event.total))
        notes.push(dimNote(`The answers are those of the pairs ${grouped(event.first)} to `
            + `${grouped(answer.end)} of the ${grouped(event.total)} that were asked.`));
    if (answer && event.kind >= KIND_ALL)
        notes.push(dimNote("All other pairs that were answered are separated."));
    return notes;
}

function fillPairs(event) {
    const pairs = stage.pairs, shown = pairs.slice(0, panel.pairs);
    const sides = shown.flatMap((pair) => [pair.then, pair.now]);
    const has = { times: sides.some(timesOf), gaps: sides.some(gapOf), boxes: sides.some(boxOf) };
    const names = ["pair", "verdict", ...(has.times ? ["in contact, s"] : []),
        ...(has.gaps ? ["gap"] : []), ...(has.boxes ? ["box"] : [])];
    show(find("event-pairs"), shown.length === 0 ? null
        : makeTable("pairs", names, shown.map((pair) => makePairRow(pair, has))),
        ...pairNotes(event, pairs.length - shown.length));
}

/* ---- The frames ---- */

function vectorText(numbers) {
    return `(${numbers.map(short).join(", ")})`;
}

function makeFrameRow(frame) {
    const exactly = (numbers) => numbers ? numbers.map(exact).join(", ") : null;
    return make("tr", {}, make("td", {}, bodyName(frame.id)),
        make("td", {}, shapeName(frame.shape)),
        make("td", { class: "number", title: exactly(frame.position) },
            vectorText(frame.position)),
        make("td", { class: "number", title: exactly(frame.orientation) },
            frame.rotation ? vectorText(frame.orientation) : "none"),
        make("td", { class: "number", title: exactly(frame.velocity) },
            frame.velocity ? vectorText(frame.velocity) : "at rest"));
}

function fillFrames() {
    const known = stage.drawable, shown = known.slice(0, FRAMES_FIRST);
    const names = ["body", "shape", "position", "orientation", "velocity, 1/s"], left = known.length - shown.length;
    show(find("event-frames"), known.length === 0 ? null : make("details", {},
        make("summary", {}, counted(known.length, "body", "bodies")),
        makeTable("frames", names, shown.map(makeFrameRow)),
        left > 0 ? dimNote(`and ${grouped(left)} more`) : null));
}

/* ---- Below the scene ---- */

function fillNotDrawn(event) {
    const missing = stage.frames.filter((frame) => !frame.shape), shown = missing.slice(0, 10);
    const lines = shown.map((frame) => `not drawn: body ${bodyName(frame.id)}: ${frame.why}`);
    if (missing.length > shown.length)
        lines.push(`and ${grouped(missing.length - shown.length)} more`);
    if (event.more_frames)
        lines.push(`not drawn: ${grouped(event.more_frames)} frames beyond the most of a scene`);
    show(find("not-drawn"), ...lines.map((line) => make("li", {}, line)));
    find("stage-said").textContent = stage.drawable.length > 0 ? ""
        : event.frames.length === 0 ? "no bodies" : "nothing that can be drawn";
}

function describeStage(event) {
    const pairs = stage.pairs.slice(0, 20).map((pair) => `${pair.ids.map(bodyName).join(" and ")} `
        + verdictName(verdictOf(pair.now ?? pair.then)));
    const dim = stage.drawable[0]?.shape.dim;
    find("stage").setAttribute("aria-label", `${dim ? `${dim}D, ` : ""}`
        + `${counted(stage.drawable.length, "body", "bodies")} drawn. ${pairs.join("; ")}`);
    find("scene-title").textContent = dim ? `Scene, ${dim}D` : "Scene";
    find("views").hidden = dim !== 3;
    find("scene-hint").textContent = dim === 3 ? "drag turns, with shift moves; wheel zooms"
        : dim === 2 ? "drag moves, wheel zooms" : "";
    find("event").dataset.at = event.at;
}

function fillEvent(event) {
    panel.pairs = PAIRS_FIRST;
    fillHead(event);
    fillFacts(event);
    fillEventDifferences(event);
    fillPairs(event);
    fillFrames();
    fillNotDrawn(event);
    describeStage(event);
}
