/* The selection: a query, a row of the timeline and a pair of the query. Keyboard commands. */

const chosen = { at: -1, row: null, pair: -1 };

/* The row in focus: the clicked one, or that of the chosen pair. */
function focusRow() {
    if (chosen.row && chosen.row !== allRow)
        return chosen.row;
    const pair = chosenPair() ?? (stage.event?.kind === KIND_PAIR ? stage.pairs[0] : null);
    return pair ? rowOf.get(rowKey(pair.ids)) : null;
}

/* Whether the chosen query names the pair of the row. */
function isNamedRow(row) {
    return chosen.at >= 0 && row !== undefined && chosen.keys.has(row.key);
}

function chosenPair() {
    return chosen.pair >= 0 ? stage.pairs[chosen.pair] : null;
}

/* The pair to show: that of the row, otherwise the first that differs. */
function pairToShow(event, row) {
    const pairs = pairsOf(event);
    if (event.kind === KIND_PAIR || pairs.length === 0)
        return -1;
    const isIt = row && row !== allRow ? (pair) => rowKey(pair.ids) === row.key
        : (pair) => pair.differs;
    const found = pairs.find(isIt);
    return found ? found.index : -1;
}

/* Puts the query into the address, so that it can be shared. Some browsers limit the rate of
 * changes: then the address is out of date. */
function setAddress(event) {
    const name = data.logs.length > 1 ? `${event.log}:${event.n}` : String(event.n);
    try {
        history.replaceState(null, "", `#${name}`);
    } catch (refused) {
        console.info(refused.message);
    }
}

function eventOfAddress() {
    const [, log, number] = /^#(?:(\d+):)?(\d+)$/.exec(location.hash) ?? [];
    return number === undefined ? null
        : events.find((event) => String(event.n) === number && event.log === Number(log ?? 0));
}

function announce(event) {
    find("announce").textContent = `query ${event.n} at ${timeText(event.seconds)} s: `
        + `${verdictName(worstOf(event))}, ${OUTCOMES[event.is]}`;
}

/* row: of the timeline, or null */
function choose(at, row) {
    const event = events[at];
    chosen.at = at;
    chosen.row = row;
    chosen.keys = new Set(pairsOf(event).map((pair) => rowKey(pair.ids)));
    chosen.pair = pairToShow(event, row);
    setScene(event);
    fillEvent(event);
    markDifference();
    scrollToEvent(at);
    redrawTimeline();
    setAddress(event);
    announce(event);
    find("fit-pair").disabled = !chosenPair();
}

function choosePair(index) {
    chosen.pair = index;
    chosen.row = null;
    find("fit-pair").disabled = !chosenPair();
    drawBands();
    redrawStage();
    redrawTimeline();
    fillPairs(stage.event);
}

/* ---- Steps ---- */

/* The queries to step through: those of the row, of the filtered rows, or all. */
function stepList(inRow) {
    const row = focusRow();
    if (inRow && row)
        return fillRow(row).at;
    if (timeline.filter.length === 0)
        return allRow.at;
    const found = new Set(rows.filter(matches).flatMap((of) => of.at));
    return [...found].sort((a, b) => a - b);
}

function stepTo(list, forward, row) {
    const at = forward ? list.find((of) => of > chosen.at)
        : list.findLast((of) => of < chosen.at);
    if (at !== undefined)
        choose(at, row);
}

function step(forward, inRow) {
    stepTo(stepList(inRow), forward, inRow ? chosen.row : null);
}

function stepDifference(forward) {
    const list = differing.map((event) => event.at);
    const before = chosen.at;
    stepTo(list, forward, null);
    if (chosen.at === before && list.length > 0) /* wraps around */
        choose(forward ? list[0] : list[list.length - 1], null);
}

const KEYS = {
    ArrowLeft: (key) => step(false, key.shiftKey),
    ArrowRight: (key) => step(true, key.shiftKey),
    d: () => stepDifference(true),
    D: () => stepDifference(false),
    "+": () => zoomMiddle(1 / 2),
    "-": () => zoomMiddle(2),
    0: () => setView(...wholeView()),
    " ": togglePlaying,
    Escape: () => choosePair(-1),
};

/* ---- Start ---- */

function listenToSteps() {
    listenToKeys(KEYS);
    find("previous").addEventListener("click", (click) => step(false, click.shiftKey));
    find("next").addEventListener("click", (click) => step(true, click.shiftKey));
    find("previous-difference").addEventListener("click", () => stepDifference(false));
    find("next-difference").addEventListener("click", () => stepDifference(true));
    find("more-differences").addEventListener("click", () => {
        panel.differences += DIFFERENCES_MORE;
        fillDifferences();
    });
    addEventListener("hashchange", () => {
        const event = eventOfAddress();
        if (event && event.at !== chosen.at)
            choose(event.at, null);
    });
}

/* The first selection: the query in the address, otherwise the first difference, otherwise the
 * first contact. */
function firstEvent() {
    return eventOfAddress() ?? differing[0]
        ?? events.find((event) => worstOf(event) >= TOUCHING) ?? events[0];
}

function start() {
    fillHeader();
    fillLegends();
    fillDifferences();
    const none = events.length === 0;
    for (const id of ["timeline", "bottom"])
        find(id).hidden = none;
    for (const id of ["previous-difference", "next-difference"])
        find(id).disabled = differing.length === 0;
    if (none)
        return;
    startTimeline();
    startStage();
    listenToSteps();
    choose(firstEvent().at, null);
}

start();
