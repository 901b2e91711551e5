/* The timeline: an overview, an axis, and a row for each pair of bodies.
 *
 * In a row the verdict of a query holds until the next query of the row. Where queries pause, the
 * bar ends. Verdicts differ in height as well as in colour. */

const ROW = 26, OVERVIEW = 20, AXIS_TOP = 34, ROWS_TOP = 62; /* pixels */
const EDGE = 12;                 /* pixels left of the first query and right of the last */
const BAR_HEIGHT = { [-1]: 4, 0: 4, 1: 8, 2: 14, 3: 20 };
const SHORTEST_BAR = 3, DOT_SPACE = 9, FLAG_SPACE = 13;
const PAUSE_OF_ROW = 10;         /* in mean steps of the row: a longer pause ends a bar */
const ROWS_FIRST = 8, ROWS_MORE = 40;
const SHORTEST_VIEW = 2e-5;      /* seconds */

const clock = makeClock(events.map((event) => event.seconds));
const places = events.map((event) => clock.at(event.seconds));

const timeline = {
    from: 0, to: 1,              /* visible range, places of the clock */
    width: 600,                  /* pixels */
    shown: ROWS_FIRST, filter: [], rows: [],
};

function wholeView() {
    return [0, clock.length > 0 ? clock.length : 1];
}

function innerWidth() {
    return Math.max(timeline.width - 2 * EDGE, 1);
}

function toX(place) {
    return EDGE + (place - timeline.from) / (timeline.to - timeline.from) * innerWidth();
}

function toPlace(x) {
    return timeline.from + (x - EDGE) / innerWidth() * (timeline.to - timeline.from);
}

/* ---- View ---- */

function setView(from, to) {
    const [first, last] = wholeView();
    const length = clamp(to - from, Math.min(SHORTEST_VIEW, last - first), last - first);
    const middle = (from + to) / 2;
    timeline.from = clamp(middle - length / 2, first, last - length);
    timeline.to = timeline.from + length;
    redrawTimeline();
}

function zoomAround(place, factor) {
    setView(place - (place - timeline.from) * factor, place + (timeline.to - place) * factor);
}

/* Moves the view just far enough to show the event. */
function scrollToEvent(at) {
    const length = timeline.to - timeline.from, place = places[at], margin = length * 0.08;
    if (place < timeline.from + margin)
        setView(place - margin, place - margin + length);
    else if (place > timeline.to - margin)
        setView(place + margin - length, place + margin);
}

function matches(row) {
    const wanted = timeline.filter;
    return wanted.length < 2 ? wanted.length === 0 || row.ids.includes(wanted[0])
        : row.key === rowKey(wanted);
}

/* ---- Bars ---- */

/* The mean step of a row: in queries of the log, and on the clock. */
function rowSteps(row) {
    const last = row.at.length - 1;
    const mean = (numbers) => last > 0 ? (numbers(last) - numbers(0)) / last : 0;
    row.steps ??= { queries: mean((i) => row.at[i]), place: mean((i) => places[row.at[i]]) };
    return row.steps;
}

/* Whether there is a pause after query i of the row: a long time without queries, or many queries
 * without this pair. Uneven steps alone are not a pause. */
function isPauseAfter(row, i) {
    if (i + 1 === row.at.length)
        return true;
    const [at, next] = [row.at[i], row.at[i + 1]];
    return next - at > PAUSE_OF_ROW * rowSteps(row).queries || clock.pauses.some(
        ({ from }) => from >= events[at].seconds && from < events[next].seconds);
}

/* The place from which on only differences were kept. */
const leftOutPlace = data.left_out.every((count) => count === 0)
    ? Infinity : clock.at((Number(data.left_span[0]) - Number(data.begin)) / 1e6);

/* The place where the bar of query i of the row ends: before the range that was left out. */
function barEnd(row, i) {
    const begin = places[row.at[i]], cut = begin < leftOutPlace ? leftOutPlace : Infinity;
    return Math.min(cut, isPauseAfter(row, i)
        ? begin + Math.min(rowSteps(row).place, clock.length / 100) : places[row.at[i + 1]]);
}

/* The range of queries of the row that may be visible. */
function visibleRange(row) {
    const from = lowerBound(row.at, lowerBound(places, timeline.from));
    const to = lowerBound(row.at, lowerBound(places, timeline.to + 1e-12));
    return [Math.max(from - 1, 0), Math.min(to + 1, row.at.length)];
}

/* Runs of equal verdicts, in pixels. Runs narrower than a pixel and a half are merged, with the
 * worst verdict. */
function runsOf(row) {
    const runs = [], [begin, end] = visibleRange(row);
    for (let i = begin; i < end; i++) {
        const run = {
            from: toX(places[row.at[i]]), to: toX(barEnd(row, i)), verdict: row.verdict[i],
            at: row.at[i], count: 1,
        };
        const last = runs[runs.length - 1];
        const joined = last && run.from <= last.to + 0.01;
        if (joined && last.verdict === run.verdict) {
            last.to = Math.max(run.to, last.to);
            last.count++;
        } else if (last && last.to - last.from < 1.5 && run.from < last.from + 1.5) {
            if (run.verdict > last.verdict)
                last.at = run.at;
            last.verdict = Math.max(last.verdict, run.verdict);
            last.to = Math.max(run.to, last.to);
            last.count++;
        } else {
            runs.push(run);
        }
    }
    return runs;
}

function drawRun(run, middle) {
    const height = BAR_HEIGHT[run.verdict];
    const from = clamp(run.from, -SHORTEST_BAR, timeline.width);
    const to = clamp(run.to, 0, timeline.width + SHORTEST_BAR);
    const kind = run.verdict < SEPARATED ? "none" : VERDICTS[run.verdict];
    return draw("rect", {
        class: `run ${kind}`, x: from.toFixed(2), y: middle - height / 2, rx: 1.5, height,
        width: Math.max(to - from, SHORTEST_BAR).toFixed(2), "data-at": run.at,
    }, draw("title", {}, `${verdictName(run.verdict)}, ${counted(run.count, "query", "queries")}`
        + ` from ${timeText(events[run.at].seconds)} s`));
}

/* Draws the queries as dots if there is space. */
function drawDots(row, middle) {
    const [begin, end] = visibleRange(row);
    if ((end - begin) * DOT_SPACE > timeline.width)
        return [];
    return row.at.slice(begin, end).map((at) => draw("circle",
        { class: "dot", cx: toX(places[at]).toFixed(2), cy: middle, r: 1.6 }));
}

/* Differences as flags; close ones become one flag with their number. */
function flagsOf(row) {
    const flags = [];
    for (const at of row.differs) {
        const x = toX(places[at]), last = flags[flags.length - 1];
        if (x < -FLAG_SPACE || x > timeline.width + FLAG_SPACE)
            continue;
        if (last && x - last.x < (last.count > 1 ? 2 : 1) * FLAG_SPACE)
            last.count++;
        else
            flags.push({ x, at, count: 1 });
    }
    return flags;
}

function drawFlag(flag, row, middle) {
    const many = flag.count > 1, width = many ? 15 + 6.5 * String(flag.count).length : 13;
    const label = `${counted(flag.count, "difference", "differences")}, bodies `
        + `${row.ids.map(bodyName).join(" and ")}, from ${timeText(events[flag.at].seconds)} s`;
    return draw("g", {
        class: "flag", role: "button", tabindex: 0, "aria-label": label, "data-at": flag.at,
        transform: `translate(${flag.x.toFixed(2)} ${middle})`,
    }, draw("path", { class: "pole", d: "M0 -12V12" }),
        draw("rect", { x: -0.75, y: -12.5, width, height: 13, rx: 2.5 }),
        draw("text", { x: 5.7, y: -2.2 }, "≠"),
        many ? draw("text", { class: "many", x: 12, y: -2.4 }, String(flag.count)) : null,
        draw("title", {}, label));
}

function drawRow(row, number) {
    const top = ROWS_TOP + number * ROW, middle = top + ROW / 2;
    return draw("g", { class: `row${row === focusRow() ? " chosen" : ""}`, "data-row": row.key },
        draw("rect", { class: "lane", x: 0, y: top, width: timeline.width, height: ROW }),
        ...runsOf(row).map((run) => drawRun(run, middle)), ...drawDots(row, middle),
        ...flagsOf(row).map((flag) => drawFlag(flag, row, middle)));
}

/* ---- Axis and overview ---- */

/* The ranges between breaks, in which the axis is linear. */
function segments() {
    const [, last] = wholeView();
    let from = -Infinity;
    const list = clock.breaks.map((fold) => {
        const segment = [from, fold.place];
        from = fold.place + fold.width;
        return segment;
    });
    list.push([from, Infinity]);
    return list.map(([a, b]) => [Math.max(a, timeline.from), Math.min(b, timeline.to, last + 1)])
        .filter(([a, b]) => a <= b);
}

function ticks() {
    const step = niceStep((timeline.to - timeline.from) / Math.max(innerWidth() / 95, 2));
    const list = [];
    for (const [from, to] of segments()) {
        const first = Math.ceil(clock.time(from) / step - 1e-9);
        for (let k = first; k * step <= clock.time(to) + step * 1e-9 && k < first + 100; k++)
            list.push({ x: toX(clock.at(k * step)), text: secondsText(k * step, step) });
    }
    const seen = list.filter((tick) => tick.x > 4 && tick.x < timeline.width - 4);
    seen.slice(-1).forEach((tick) => {
        tick.text += " s";
    });
    return seen;
}

/* Half the width of a text on the axis with a margin, pixels. */
function halfOf(text) {
    return 4.2 * text.length + 3;
}

function breakText(fold) {
    return `⋯ ${durationText(fold.seconds)}`;
}

/* Selects axis labels that do not overlap: the cursor's first, then those of breaks, then ticks.
 * Each is {x, text}; labels that do not fit into the width are left out. */
function fitTexts(marks) {
    const at = cursorText(), kept = at ? [at] : [];
    const breaks = clock.breaks.map((fold) =>
        ({ fold, x: toX(fold.place + fold.width / 2), text: breakText(fold) }));
    for (const one of [...breaks, ...marks]) {
        const half = halfOf(one.text);
        if (one.x >= half && one.x <= timeline.width - half
            && kept.every((other) => Math.abs(other.x - one.x) >= halfOf(other.text) + half))
            kept.push(one);
    }
    return new Set(kept.map((one) => one.fold ?? one));
}

function drawTick(tick, bottom, fits) {
    const x = tick.x.toFixed(1);
    return draw("g", { class: "tick" },
        draw("path", { d: `M${x} ${AXIS_TOP + 18}V${bottom}` }),
        fits ? draw("text", { x, y: AXIS_TOP + 12 }, tick.text) : null);
}

function drawBreak(fold, bottom, fits) {
    const x = toX(fold.place), width = toX(fold.place + fold.width) - x;
    if (x > timeline.width || x + width < 0)
        return null;
    return draw("g", { class: "fold" },
        draw("rect", { x: x.toFixed(1), y: AXIS_TOP + 18, width, height: bottom - AXIS_TOP - 18 }),
        fits ? draw("text", { x: (x + width / 2).toFixed(1), y: AXIS_TOP + 12 }, breakText(fold))
            : null,
        draw("title", {}, `${durationText(fold.seconds)} without queries`));
}

function drawLeftOut(bottom) {
    if (leftOutPlace === Infinity)
        return null;
    const x = clamp(toX(leftOutPlace), 0, timeline.width);
    return draw("g", { class: "left-out" },
        draw("rect", { x, y: ROWS_TOP, width: timeline.width - x, height: bottom - ROWS_TOP }),
        draw("title", {}, "not shown from here on, but for differences"));
}

/* The whole log in columns of two pixels, each with its worst verdict. */
function overviewColumns(xOf) {
    const width = 2, columns = new Map();
    allRow.at.forEach((at, i) => {
        const last = Math.max(xOf(barEnd(allRow, i)) - 0.01, xOf(places[at]));
        for (let x = Math.floor(xOf(places[at]) / width); x <= last / width; x++)
            columns.set(x, Math.max(columns.get(x) ?? NO_VERDICT, allRow.verdict[i]));
    });
    return [...columns].map(([x, verdict]) => {
        const height = BAR_HEIGHT[verdict] * 0.75;
        return draw("rect", {
            class: verdict < SEPARATED ? "none" : VERDICTS[verdict], x: x * width,
            y: OVERVIEW - 2 - height, width, height,
        });
    });
}

function drawOverview() {
    const [first, last] = wholeView();
    const xOf = (place) => EDGE + (place - first) / (last - first) * innerWidth();
    const flags = [...new Set(allRow.differs.map((at) => Math.floor(xOf(places[at]) / 3)))]
        .map((x) => draw("path", { class: "mark", d: `M${x * 3 - 3.5} 0h7l-3.5 6Z` }));
    const whole = timeline.to - timeline.from > (last - first) * 0.999;
    const brush = draw("rect", {
        class: `brush${whole ? " whole" : ""}`, x: xOf(timeline.from).toFixed(1), y: 0.5,
        width: Math.max(xOf(timeline.to) - xOf(timeline.from), 2).toFixed(1), height: OVERVIEW - 1,
    });
    return draw("g", { id: "overview" }, draw("rect",
        { class: "ground", x: 0, y: 0, width: timeline.width, height: OVERVIEW, rx: 3 }),
        ...overviewColumns(xOf), brush, ...flags);
}

/* The label of the cursor, moved into the width: {x, text}, with the x of the cursor; or null. */
function cursorText() {
    const x = chosen.at < 0 ? -1 : toX(places[chosen.at]);
    if (x < 0 || x > timeline.width)
        return null;
    const text = `${timeText(events[chosen.at].seconds)} s`, half = halfOf(text);
    return { x: clamp(x, half, timeline.width - half), text, line: x };
}

function drawCursor(bottom) {
    const at = cursorText();
    if (!at)
        return null;
    const half = halfOf(at.text);
    return draw("g", { class: "cursor" },
        draw("path", { d: `M${at.line.toFixed(2)} ${AXIS_TOP + 17}V${bottom}` }),
        draw("rect", { x: at.x - half, y: AXIS_TOP - 1, width: 2 * half, height: 18, rx: 4 }),
        draw("text", { x: at.x.toFixed(1), y: AXIS_TOP + 12 }, at.text));
}

/* ---- Labels ---- */

function rowText(row) {
    if (row === allRow)
        return "all queries: go to the next one";
    return `bodies ${row.ids.map(bodyName).join(" and ")}: `
        + `${counted(row.differs.length, "difference", "differences")}, in contact in `
        + `${grouped(row.contacts)} of ${counted(row.at.length, "query", "queries")}`
        + "; go to the next of these";
}

function makeLabel(row) {
    const name = row === allRow ? "all queries" : row.ids.map(bodyName).join(" – ");
    return make("button", {
        class: "label", "data-row": row.key,
        title: rowText(row), "aria-label": rowText(row), onclick: () => stepInRow(row),
    }, make("span", { class: "name" }, name), row.differs.length === 0 ? null
        : make("span", { class: "badge" }, `≠ ${grouped(row.differs.length)}`));
}

/* The query of the row to step to: the next difference or contact, otherwise the next one. */
function stepInRow(row) {
    const worth = row.at.filter((at, i) => row.verdict[i] >= TOUCHING || row.differs.includes(at));
    const list = row === allRow || worth.length === 0 ? row.at : worth;
    const next = list.find((at) => at > chosen.at) ?? list[0];
    if (next !== undefined)
        choose(next, row);
}

/* ---- Drawing ---- */

function listRows() {
    const found = rows.filter(matches);
    timeline.rows = [allRow, ...found.slice(0, timeline.shown)];
    timeline.rows.forEach(fillRow);
    const more = found.length - timeline.shown, button = find("more-rows");
    button.hidden = more <= 0;
    const pairs = counted(found.length, "pair", "pairs");
    button.textContent = `show ${grouped(Math.min(more, ROWS_MORE))} more of ${pairs}`;
    find("rows-said").textContent = timeline.filter.length === 0 ? ""
        : found.length === 0 ? "no pair with it" : pairs;
    show(find("row-labels"), ...timeline.rows.map(makeLabel));
}

function markLabels() {
    const focus = focusRow();
    for (const label of find("row-labels").children) {
        const row = rowOf.get(label.dataset.row);
        label.classList.toggle("named", isNamedRow(row));
        label.classList.toggle("chosen", row !== undefined && row === focus);
    }
}

/* Flags are rebuilt: returns the focused one, so that its replacement can get the focus. */
function focusedFlag() {
    const flag = document.activeElement?.closest(".flag"), row = flag?.closest(".row").dataset.row;
    return flag ? `[data-row="${row}"] .flag[data-at="${flag.dataset.at}"]` : "none";
}

function drawTimeline() {
    const plot = find("plot"), focused = focusedFlag();
    timeline.width = Math.max(plot.parentNode.clientWidth - find("row-labels").offsetWidth, 120);
    const bottom = ROWS_TOP + timeline.rows.length * ROW;
    plot.setAttribute("width", timeline.width);
    plot.setAttribute("height", bottom + 2);
    const marks = ticks(), fit = fitTexts(marks);
    show(plot, drawOverview(),
        ...marks.map((tick) => drawTick(tick, bottom, fit.has(tick))),
        draw("g", { id: "lanes" }, ...timeline.rows.map(drawRow)), drawLeftOut(bottom),
        ...clock.breaks.map((fold) => drawBreak(fold, bottom, fit.has(fold))),
        drawCursor(bottom));
    markLabels();
    find("plot").querySelector(focused)?.focus();
}

const redrawTimeline = onceAFrame(drawTimeline);

/* ---- Mouse and keyboard ---- */

/* The query of the row at x: a nearby difference, otherwise the one whose bar is at x, otherwise
 * the nearest. */
function eventAt(row, x) {
    let best = -1, distance = Infinity;
    for (const at of row.differs) {
        const away = Math.abs(toX(places[at]) - x);
        if (away < Math.min(distance, 5))
            [best, distance] = [at, away];
    }
    if (best >= 0 || row.at.length === 0)
        return best;
    const last = row.at.length - 1;
    const i = clamp(lowerBound(row.at, lowerBound(places, toPlace(x + 1))) - 1, 0, last);
    const next = Math.min(i + 1, last);
    const isIn = toX(barEnd(row, i)) + SHORTEST_BAR >= x;
    const nearer = Math.abs(toX(places[row.at[next]]) - x) < Math.abs(toX(barEnd(row, i)) - x);
    return row.at[!isIn && nearer ? next : i];
}

/* Chooses the query at the pointer. A narrow run represents several queries: the worst is chosen.
 */
function clickPlot(mouse) {
    const flag = mouse.target.closest(".flag"), lane = mouse.target.closest(".row");
    const row = lane && (rowOf.get(lane.dataset.row) ?? allRow);
    if (flag) {
        choose(Number(flag.dataset.at), row);
    } else if (row) {
        const run = mouse.target.closest(".run");
        const narrow = run && Number(run.getAttribute("width")) <= SHORTEST_BAR;
        const at = narrow ? Number(run.dataset.at) : eventAt(row, pointIn("plot", mouse).x);
        if (at >= 0)
            choose(at, row);
    }
}

/* Moves the view: in the overview to the pointer, elsewhere with it. */
function dragTo(begin, point) {
    const [first, last] = wholeView(), length = begin.to - begin.from;
    if (begin.y < OVERVIEW + 4) {
        const middle = first + (point.x - EDGE) / innerWidth() * (last - first);
        setView(middle - length / 2, middle + length / 2);
    } else {
        const moved = (begin.x - point.x) / innerWidth() * length;
        setView(begin.from + moved, begin.to + moved);
    }
}

function listenToDrag(plot) {
    let dragged = false;
    listenToDrags(plot, (mouse) => {
        const begin = { ...pointIn("plot", mouse), from: timeline.from, to: timeline.to };
        dragged = false;
        return (moved) => {
            const point = pointIn("plot", moved);
            dragged = dragged || Math.abs(point.x - begin.x) >= 4;
            if (dragged)
                dragTo(begin, point);
        };
    });
    plot.addEventListener("click", (mouse) => {
        const point = pointIn("plot", mouse);
        if (dragged)
            return;
        if (point.y < OVERVIEW + 4)
            dragTo({ ...point, from: timeline.from, to: timeline.to }, point);
        else
            clickPlot(mouse);
    });
}

function listenToPlot() {
    const plot = find("plot");
    listenToDrag(plot);
    plot.addEventListener("wheel", (wheel) => {
        wheel.preventDefault();
        const by = wheel.deltaX / innerWidth() * (timeline.to - timeline.from);
        if (Math.abs(wheel.deltaX) > Math.abs(wheel.deltaY))
            setView(timeline.from + by, timeline.to + by);
        else
            zoomAround(toPlace(pointIn("plot", wheel).x), wheelFactor(wheel));
    }, { passive: false });
    plot.addEventListener("keydown", (key) => {
        const flag = key.target.closest(".flag");
        if (flag && (key.key === "Enter" || key.key === " ")) {
            key.preventDefault();
            key.stopPropagation();
            choose(Number(flag.dataset.at), rowOf.get(flag.closest(".row").dataset.row) ?? allRow);
        }
    });
}

function setFilter(text) {
    const words = text.trim().split(/[\s,–-]+/).filter((word) => word !== "");
    timeline.filter = words.slice(0, 2).map((word) => word === "anonymous" ? "0" : word);
    timeline.shown = ROWS_FIRST;
    listRows();
    redrawTimeline();
}

function zoomMiddle(factor) {
    const place = places[chosen.at], inView = place >= timeline.from && place <= timeline.to;
    zoomAround(inView ? place : (timeline.from + timeline.to) / 2, factor);
}

function listenToBar() {
    find("zoom-in").addEventListener("click", () => zoomMiddle(1 / 2));
    find("zoom-out").addEventListener("click", () => zoomMiddle(2));
    find("zoom-all").addEventListener("click", () => setView(...wholeView()));
    find("filter").addEventListener("input", (input) => setFilter(input.target.value));
    find("more-rows").addEventListener("click", () => {
        timeline.shown += ROWS_MORE;
        listRows();
        redrawTimeline();
    });
}

function startTimeline() {
    [timeline.from, timeline.to] = wholeView();
    listenToPlot();
    listenToBar();
    listRows();
    new ResizeObserver(redrawTimeline).observe(find("rows"));
    drawTimeline();
}
